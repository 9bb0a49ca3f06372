/* Draws scenes. */
#ifndef SCENE_H
#define SCENE_H

/* The sides of the surface, in which the largest scene has room. */
#define SURFACE_WIDTH 1024
#define SURFACE_HEIGHT 256

enum scene_status { SCENE_DRAWN, SCENE_UNSUPPORTED, SCENE_FAILED };

/* Draws PACK/scenes/NAME.scene.txt and writes what it reads back as RESULTS/NAME.png. A message tells why it is not drawn. */
enum scene_status scene_draw(const char *pack, const char *results, const char *name, char *message);

#endif
