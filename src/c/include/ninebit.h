/* The library ninebit for C. Made of src/c/lib.rs by cbindgen; docs/c.md shows how it is used. */

#ifndef NINEBIT_H
#define NINEBIT_H

#include <stddef.h>
#include <stdint.h>

/*
 How a call ended. The numbers are the exit statuses of the program.
 */
enum ninebit_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /*
   The call did what was asked.
   */
  NINEBIT_STATUS_OK = 0,
  /*
   A null pointer, a number that is too large, a buffer that is too small.
   */
  NINEBIT_STATUS_ARGUMENT = 2,
  /*
   A scene, one of its files, or register words are invalid.
   */
  NINEBIT_STATUS_INVALID = 3,
  /*
   A file is missing.
   */
  NINEBIT_STATUS_MISSING = 4,
  /*
   A limit was exceeded.
   */
  NINEBIT_STATUS_LIMIT = 5,
  /*
   A fault of this library.
   */
  NINEBIT_STATUS_INTERNAL = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ninebit_status ninebit_status;
#else
typedef int32_t ninebit_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/*
 The chip whose rules hold.
 */
enum ninebit_chip
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /*
   GeForce 256: methods of the Celsius class.
   */
  NINEBIT_CHIP_NV10 = 0,
  /*
   GeForce 3 and Xbox: methods of the Kelvin class.
   */
  NINEBIT_CHIP_NV2A = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum ninebit_chip ninebit_chip;
#else
typedef int32_t ninebit_chip;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/*
 A scene that was read and checked. Threads may share it.
 */
typedef struct ninebit_scene ninebit_scene;

/*
 A method of the chip's 3D class and the word written to it.
 */
typedef struct ninebit_method {
  /*
   Its number, 0x0ac0 for example.
   */
  uint32_t method;
  /*
   The word that is written to it.
   */
  uint32_t word;
} ninebit_method;

/*
 What a pixel brings to the combiners: R, G, B, A of each register, textures -256 to 255, colours and fog 0 to 255. Fog's alpha is the factor.
 */
typedef struct ninebit_inputs {
  /*
   Interpolated diffuse colour.
   */
  int32_t primary[4];
  /*
   Interpolated specular colour.
   */
  int32_t secondary[4];
  /*
   Fog colour and factor.
   */
  int32_t fog[4];
  /*
   What each texture unit yields.
   */
  int32_t texture[4][4];
} ninebit_inputs;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 The version of the library, `0.1.0` for example. Do not free it.
 */
const char *ninebit_version(void);

/*
 Reads and checks the scene file at `path`; files that it names are looked for in its folder. Free the scene with `ninebit_scene_free`.

 Where it fails, `*scene` is null and `*message` says why, with places and stable codes. `message` may be null.

 # Safety
 `path` ends with a zero; `scene` and `message` are null or may be written.
 */
ninebit_status ninebit_scene_load(const char *path,
                                  struct ninebit_scene **scene,
                                  char **message);

/*
 Reads and checks a scene from its text, `length` bytes of UTF-8. `origin` is its path: messages name it, and the files that the scene names are looked for
 in its folder. Otherwise as `ninebit_scene_load`.

 # Safety
 `text` points to `length` bytes, `origin` ends with a zero; `scene` and `message` are null or may be written.
 */
ninebit_status ninebit_scene_parse(const char *text,
                                   size_t length,
                                   const char *origin,
                                   struct ninebit_scene **scene,
                                   char **message);

/*
 Frees a scene; null is none.

 # Safety
 `scene` is null or came from this library, was not freed before and is used by no other thread.
 */
void ninebit_scene_free(struct ninebit_scene *scene);

/*
 Frees a text that this library has made; null is none.

 # Safety
 `text` is null or came from this library and was not freed before.
 */
void ninebit_text_free(char *text);

/*
 Columns and rows of target number `target`.

 # Safety
 `scene` is one of this library's; `width`, `height` and `message` are null or may be written.
 */
ninebit_status ninebit_target_size(const struct ninebit_scene *scene,
                                   size_t target,
                                   uint32_t *width,
                                   uint32_t *height,
                                   char **message);

/*
 Renders the scene and hands over target number `target`, row by row from above: its stored words, and R, G, B, A bytes as a picture shows them. Either may
 be null. `threads`: 0 takes one a core; no byte depends on it.

 # Safety
 `scene` is one of this library's; `words` is null or has room for `pixels` words, `rgba` is null or for `pixels` times 4 bytes; `message` is null or may be
 written.
 */
ninebit_status ninebit_render(const struct ninebit_scene *scene,
                              size_t target,
                              size_t threads,
                              uint32_t *words,
                              uint8_t *rgba,
                              size_t pixels,
                              char **message);

/*
 How pixel (x, y) of target number `target` came to be, every integer with its rule: the document of `ninebit trace --format json`. Free it with
 `ninebit_text_free`.

 # Safety
 `scene` is one of this library's; `json` and `message` are null or may be written.
 */
ninebit_status ninebit_trace(const struct ninebit_scene *scene,
                             size_t target,
                             uint32_t x,
                             uint32_t y,
                             char **json,
                             char **message);

/*
 Runs the program that register words are on pixels: R, G, B, A of each fragment, four bytes a pixel, as they reach the raster operations. Methods that are not
 the combiners' are passed over; words that are not written are 0.

 # Safety
 `methods` points to `method_count` pairs, `inputs` to `pixels` inputs, `fragments` to room for `pixels` times 4 bytes; `message` is null or may be written.
 */
ninebit_status ninebit_evaluate(int32_t chip,
                                const struct ninebit_method *methods,
                                size_t method_count,
                                const struct ninebit_inputs *inputs,
                                uint8_t *fragments,
                                size_t pixels,
                                char **message);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* NINEBIT_H */
