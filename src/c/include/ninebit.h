/* The library ninebit for C. Made from src/c/lib.rs by cbindgen; docs/c.md shows how it is used. */

#ifndef NINEBIT_H
#define NINEBIT_H

#include <stddef.h>
#include <stdint.h>

/*
 Status of a call. The numbers are the exit statuses of the program.
 */
enum ninebit_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /*
   The call succeeded.
   */
  NINEBIT_STATUS_OK = 0,
  /*
   An argument is wrong: a null pointer, a number that is too large, or a buffer of the wrong size.
   */
  NINEBIT_STATUS_ARGUMENT = 2,
  /*
   A scene, one of its files, or the register words are invalid.
   */
  NINEBIT_STATUS_INVALID = 3,
  /*
   A file is missing.
   */
  NINEBIT_STATUS_MISSING = 4,
  /*
   A limit has been exceeded, or the system has no thread left.
   */
  NINEBIT_STATUS_LIMIT = 5,
  /*
   A fault of this library has occurred.
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
 The chip whose rules apply.
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
 A scene that has been read and checked. Threads may share it.
 */
typedef struct ninebit_scene ninebit_scene;

/*
 A method of the chip's 3D class with the word written to it.
 */
typedef struct ninebit_method {
  /*
   Number of the method, for example 0x0ac0.
   */
  uint32_t method;
  /*
   Word that is written to the method.
   */
  uint32_t word;
} ninebit_method;

/*
 Inputs of the combiners for a pixel: R, G, B, A of each register. Textures are -256 to 255, colours and fog 0 to 255.
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
   Fog colour; alpha is the fog factor.
   */
  int32_t fog[4];
  /*
   Colour of each texture unit.
   */
  int32_t texture[4][4];
} ninebit_inputs;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Returns the version of the library, for example `0.1.0`. Do not free it.
 */
const char *ninebit_version(void);

/*
 Reads and checks the scene file at `path`. The files that it names are looked for in its folder. Free the scene with `ninebit_scene_free`.

 If the call fails, `*scene` is null and `*message` says why, with places and stable codes. `message` may be null.

 # Safety
 `path` ends with a zero; `scene` and `message` are null or may be written.
 */
ninebit_status ninebit_scene_load(const char *path,
                                  struct ninebit_scene **scene,
                                  char **message);

/*
 Reads and checks a scene from its text, which is `length` bytes of UTF-8. `origin` is its path: messages show it, and the files that the scene
 names are looked for in its folder. Apart from that it is like `ninebit_scene_load`.

 # Safety
 `text` points to `length` bytes, `origin` ends with a zero; `scene` and `message` are null or may be written.
 */
ninebit_status ninebit_scene_parse(const char *text,
                                   size_t length,
                                   const char *origin,
                                   struct ninebit_scene **scene,
                                   char **message);

/*
 Frees a scene. Null is ignored.

 # Safety
 `scene` is null, or came from this library, has not been freed and is not used by another thread.
 */
void ninebit_scene_free(struct ninebit_scene *scene);

/*
 Frees a text that came from this library. Null is ignored.

 # Safety
 `text` is null, or came from this library and has not been freed.
 */
void ninebit_text_free(char *text);

/*
 Writes the number of columns and rows of the target with number `target`.

 # Safety
 `scene` came from this library; `width`, `height` and `message` are null or may be written.
 */
ninebit_status ninebit_target_size(const struct ninebit_scene *scene,
                                   size_t target,
                                   uint32_t *width,
                                   uint32_t *height,
                                   char **message);

/*
 Renders the scene and writes the target with number `target`, row by row from the top: its stored words, and bytes R, G, B, A as a picture shows
 them. Either may be null. `threads` is the number of threads, at most 1024, or 0 for one on each core; the result does not depend on it.

 # Safety
 `scene` came from this library; `words` is null or has room for `pixels` words, `rgba` is null or has room for 4 times as many bytes; `message` is
 null or may be written.
 */
ninebit_status ninebit_render(const struct ninebit_scene *scene,
                              size_t target,
                              size_t threads,
                              uint32_t *words,
                              uint8_t *rgba,
                              size_t pixels,
                              char **message);

/*
 Writes the document of `ninebit trace --format json` for pixel (x, y) of the target with number `target`: every integer of its computation, with
 its rule. Free it with `ninebit_text_free`.

 # Safety
 `scene` came from this library; `json` and `message` are null or may be written.
 */
ninebit_status ninebit_trace(const struct ninebit_scene *scene,
                             size_t target,
                             uint32_t x,
                             uint32_t y,
                             char **json,
                             char **message);

/*
 Runs the program in register words on pixels, and writes the fragments as they reach the raster operations: R, G, B, A, four bytes a pixel.
 Methods that do not belong to the combiners are ignored; words that are not written are 0.

 # Safety
 `methods` points to `method_count` pairs, `inputs` to `pixels` inputs, and `fragments` to room for 4 times as many bytes; `message` is null or may
 be written.
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
