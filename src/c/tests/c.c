/* Tests the library from C: results, messages of wrong calls, and use by two threads at once. The argument is a scene file. */
#include "ninebit.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a thread, in bytes. Sanitizers need some of it themselves. */
#define STACK (64 << 10)

static int failed;
#define CHECK(condition) \
    do { \
        if (!(condition)) failed = 1, printf("%s:%d: %s\n", __FILE__, __LINE__, #condition); \
    } while (0)

/* Checks a call that has to fail: its status, and a part of its message. */
static void refused(ninebit_status status, ninebit_status wanted, char **message, const char *part)
{
    CHECK(status == wanted);
    CHECK(*message != NULL && strstr(*message, part) != NULL);
    if (*message != NULL && strstr(*message, part) == NULL) printf("%s\n", *message);
    ninebit_text_free(*message);
    *message = NULL;
}

static const ninebit_scene *shared;
static uint32_t *expected;
static size_t pixels;

/* A scene whose matrix is nested as deeply as it may be, read, drawn and traced on a small stack. */
static void *small(void *unused)
{
    char text[1024] = "(version: 1, profile: Nv2a, names: (matrices: {\"a\": ", *json = NULL, *message = NULL;
    ninebit_scene *scene;
    uint32_t *words = malloc(64 * 48 * sizeof *words);
    int n;
    (void)unused;
    for (n = 0; n < 15; n++) strcat(text, "Product(");
    strcat(text, "Orthographic(left: -2, right: 2, bottom: -2, top: 2, near: -3, far: 3)");
    for (n = 0; n < 15; n++) strcat(text, ")");
    strcat(text, "}), targets: [(width: 64, height: 48, depth: Z24S8)], draws: [(vertices: Matrix(matrix: \"a\", mesh: Sphere(slices: 24, "
                 "stacks: 12), diffuse: Normal), depth_test: (function: Less))])");
    CHECK(ninebit_scene_parse(text, strlen(text), "deep.ron", &scene, &message) == NINEBIT_STATUS_OK);
    if (message) printf("%s\n", message);
    CHECK(ninebit_render(scene, 0, 1, words, NULL, 64 * 48, NULL) == NINEBIT_STATUS_OK);
    CHECK(ninebit_trace(scene, 0, 32, 24, &json, NULL) == NINEBIT_STATUS_OK && json != NULL);
    ninebit_text_free(json);
    ninebit_text_free(message);
    ninebit_scene_free(scene);
    free(words);
    return NULL;
}

static void *draw(void *unused)
{
    uint32_t *words = malloc(pixels * sizeof *words);
    (void)unused;
    CHECK(ninebit_render(shared, 0, 1, words, NULL, pixels, NULL) == NINEBIT_STATUS_OK);
    CHECK(memcmp(words, expected, pixels * sizeof *words) == 0);
    free(words);
    return NULL;
}

int main(int count, char **arguments)
{
    static const char text[] =
        "(version: 1, profile: Nv10, targets: [(width: 4, height: 2)], draws: [(vertices: Window([(position: (0, 0), diffuse: (255, 0, 0)), "
        "(position: (0, 4), diffuse: (255, 0, 0)), (position: (8, 0), diffuse: (255, 0, 0))]), program: Combiners(stages: [()], "
        "final_combiner: (d: PrimaryColor)))])";
    ninebit_scene *scene = (ninebit_scene *)&failed;
    char *message = NULL, *json = NULL;
    uint32_t width = 0, height = 0, words[8];
    uint8_t rgba[32], fragments[8];
    /* lit up: SPARE0 = expand(TEXTURE0) . expand(PRIMARY), shown as it is. */
    const ninebit_method methods[] = {{0x0ac0, 0x48440000}, {0x1e40, 0x000020c0}, {0x0288, 0x0000000c}, {0x028c, 0x00001c80}, {0x1e60, 0x00000101}};
    ninebit_inputs inputs[2] = {{{128, 200, 230, 255}, {0}, {0}, {{128, 128, 255, 255}}}, {{0, 0, 0, 255}, {0}, {0}, {{-256, 0, 0, 0}}}};
    pthread_t threads[2];
    pthread_attr_t tiny;
    int n;

    if (count != 2) return 2;
    CHECK(strlen(ninebit_version()) >= 5);
    CHECK(ninebit_scene_parse(text, sizeof text - 1, "inside.ron", &scene, &message) == NINEBIT_STATUS_OK);
    if (message) printf("%s\n", message);
    CHECK(message == NULL && scene != NULL);
    CHECK(ninebit_target_size(scene, 0, &width, &height, NULL) == NINEBIT_STATUS_OK && width == 4 && height == 2);
    CHECK(ninebit_render(scene, 0, 0, words, rgba, 8, NULL) == NINEBIT_STATUS_OK);
    CHECK((words[0] & 0xffffff) == 0xff0000 && rgba[0] == 255 && rgba[1] == 0);
    CHECK(ninebit_trace(scene, 0, 1, 0, &json, NULL) == NINEBIT_STATUS_OK && strstr(json, "primary.r") != NULL);
    ninebit_text_free(json);

    /* Wrong calls are refused with a message. */
    refused(ninebit_target_size(scene, 1, &width, &height, &message), NINEBIT_STATUS_ARGUMENT, &message, "no target 1");
    refused(ninebit_render(scene, 0, 1, words, rgba, 7, &message), NINEBIT_STATUS_ARGUMENT, &message, "8 pixels");
    refused(ninebit_render(scene, 0, 1, (uint32_t *)(rgba + 1), NULL, 8, &message), NINEBIT_STATUS_ARGUMENT, &message, "aligned");
    refused(ninebit_render(scene, 0, 1025, words, rgba, 8, &message), NINEBIT_STATUS_ARGUMENT, &message, "not a number from 0 to 1024");
    refused(ninebit_render(scene, 0, (size_t)-1, words, rgba, 8, &message), NINEBIT_STATUS_ARGUMENT, &message, "not a number from 0 to 1024");
    CHECK(ninebit_render(scene, 0, 1024, words, rgba, 8, NULL) == NINEBIT_STATUS_OK);
    refused(ninebit_trace(scene, 0, 4, 0, &json, &message), NINEBIT_STATUS_ARGUMENT, &message, "4");
    CHECK(json == NULL);
    refused(ninebit_trace(NULL, 0, 0, 0, &json, &message), NINEBIT_STATUS_ARGUMENT, &message, "scene is null");
    CHECK(ninebit_trace(scene, 0, 0, 0, NULL, NULL) == NINEBIT_STATUS_ARGUMENT);
    ninebit_scene_free(scene);
    ninebit_scene_free(NULL);
    ninebit_text_free(NULL);
    refused(ninebit_scene_parse(text, sizeof text / 2, "inside.ron", &scene, &message), NINEBIT_STATUS_INVALID, &message, "inside.ron:1");
    CHECK(scene == NULL);
    refused(ninebit_scene_parse("\xff", 1, "inside.ron", &scene, &message), NINEBIT_STATUS_ARGUMENT, &message, "UTF-8");
    refused(ninebit_scene_parse(NULL, 5, "inside.ron", &scene, &message), NINEBIT_STATUS_ARGUMENT, &message, "null");
    refused(ninebit_scene_parse(text, (size_t)-1, "inside.ron", &scene, &message), NINEBIT_STATUS_ARGUMENT, &message, "elements");
    refused(ninebit_scene_load("no such scene.ron", &scene, &message), NINEBIT_STATUS_MISSING, &message, "NB0111");
    refused(ninebit_scene_load("-", &scene, &message), NINEBIT_STATUS_MISSING, &message, "NB0111");
    refused(ninebit_scene_load(arguments[1], NULL, &message), NINEBIT_STATUS_ARGUMENT, &message, "no place");

    /* Register words. */
    CHECK(ninebit_evaluate(NINEBIT_CHIP_NV2A, methods, 5, inputs, fragments, 2, NULL) == NINEBIT_STATUS_OK);
    CHECK(fragments[0] == 203 && fragments[1] == 203 && fragments[2] == 203);
    inputs[1].primary[0] = 256;
    refused(ninebit_evaluate(NINEBIT_CHIP_NV2A, methods, 5, inputs, fragments, 2, &message), NINEBIT_STATUS_ARGUMENT, &message, "256");
    refused(ninebit_evaluate(NINEBIT_CHIP_NV10, methods, 5, inputs, fragments, 1, &message), NINEBIT_STATUS_INVALID, &message, "NB0363");
    refused(ninebit_evaluate(7, methods, 5, inputs, fragments, 1, &message), NINEBIT_STATUS_ARGUMENT, &message, "chip");

    /* A scene file, drawn by two threads at once. */
    CHECK(ninebit_scene_load(arguments[1], &scene, &message) == NINEBIT_STATUS_OK);
    if (message) printf("%s\n", message);
    CHECK(ninebit_target_size(scene, 0, &width, &height, NULL) == NINEBIT_STATUS_OK);
    pixels = (size_t)width * height, shared = scene, expected = malloc(pixels * sizeof *expected);
    CHECK(ninebit_render(scene, 0, 2, expected, NULL, pixels, NULL) == NINEBIT_STATUS_OK);
    for (n = 0; n < 2; n++) CHECK(pthread_create(&threads[n], NULL, draw, NULL) == 0);
    for (n = 0; n < 2; n++) CHECK(pthread_join(threads[n], NULL) == 0);
    free(expected);
    ninebit_scene_free(scene);

    /* A caller with little stack. */
    CHECK(pthread_attr_init(&tiny) == 0 && pthread_attr_setstacksize(&tiny, STACK) == 0);
    CHECK(pthread_create(&threads[0], &tiny, small, NULL) == 0 && pthread_join(threads[0], NULL) == 0);
    puts(failed ? "failed" : "all is well");
    return failed;
}
