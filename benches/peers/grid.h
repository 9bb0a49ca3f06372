/* ---- W14 and W15: layers of a grid of triangles, of which edges or corners are drawn. ---- */

enum { LINE_LAYERS = 22, SPRITE_LAYERS = 11, GRID_VERTICES = 64 * 48 * 6 };

typedef struct { float x, y; unsigned char color[4]; } GridVertex;

static GridVertex grid[LINE_LAYERS * GRID_VERTICES];

/* Returns the number of vertices. Lines pass through centres of pixels, corners lie between them. */
static int make_grid(int layers, int columns, int rows, double moved)
{
    /* Upper left, lower left, lower right; upper left, lower right, upper right. */
    static const int corners[6][2] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 0, 0 }, { 1, 1 }, { 1, 0 } };
    int count = 0;
    for (int n = 0; n < layers; n++) {
        double right = n % 5 * 3 + moved, down = n / 5 * 3 + moved;
        for (int cell = 0; cell < columns * rows; cell++)
            for (int corner = 0; corner < 6; corner++) {
                double x = (double)(cell % columns + corners[corner][0]) * WIDTH / columns + right;
                double y = (double)(cell / columns + corners[corner][1]) * HEIGHT / rows + down;
                GridVertex vertex = {
                    2 * x / WIDTH - 1, 1 - 2 * y / HEIGHT, { 60 + 9 * n % 190, 250 - 11 * n % 220, 40 + 7 * n % 210, 255 },
                };
                grid[count++] = vertex;
            }
    }
    return count;
}

static int send_grid(int workload)
{
    GLuint buffer;
    int count = workload == 14 ? make_grid(LINE_LAYERS, 32, 24, 0.5) : make_grid(SPRITE_LAYERS, 64, 48, 0.25);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, count * sizeof *grid, grid, GL_STATIC_DRAW);
    glVertexPointer(2, GL_FLOAT, sizeof *grid, (void *)0);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof *grid, (void *)8);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    return count;
}

static int grid_vertices;

/* Edges or corners in place of faces, without programs. */
static void set_up_grid(int workload)
{
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glUseProgram(0);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    for (int n = 3; n >= 0; n--) unit(n, 0, 0, 0, 0);
    grid_vertices = send_grid(workload);
    glPolygonMode(GL_FRONT_AND_BACK, workload == 14 ? GL_LINE : GL_POINT);
    if (workload == 15) {
        unit(0, GL_TEXTURE_2D, textures[COLOR], GL_MODULATE, GL_PRIMARY_COLOR);
        parameters(GL_TEXTURE_2D, GL_REPEAT, GL_NEAREST);
        glPointSize(8);
        glEnable(GL_POINT_SPRITE);
        glTexEnvi(GL_POINT_SPRITE, GL_COORD_REPLACE, GL_TRUE);
    }
    glClear(GL_COLOR_BUFFER_BIT);
}
