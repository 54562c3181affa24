// What a page asks about the last good run: exports, images, measures, and pictures.

#ifndef CAG_LIVE_MODEL_ANSWERS_H
#define CAG_LIVE_MODEL_ANSWERS_H

#include <stdbool.h>
#include <stddef.h>

#include "cag.h"
#include "live/json_write.h"

enum { CAG_ANSWER_NAME = 256 };

typedef struct CagModelAnswer {
  int status;                 // of HTTP; only 200 comes with bytes
  char *bytes;                // malloc'd
  size_t size;                // of the bytes
  const char *type;           // NULL: JSON
  char name[CAG_ANSWER_NAME]; // of the file to save; "": it is not to be saved
  const char *error, *help;   // `help` may be NULL; valid until the next call with the session
} CagModelAnswer;

// In these functions, `s` is the session of the last good run; NULL: there is none. `script` is the
// path of the script, and `format` one of cag_export_formats().
CagModelAnswer cag_answer_export(CagSession *s, const char *script, const char *format);
// The PNG file of an image that the script shows.
CagModelAnswer cag_answer_image(CagSession *s, const char *image);
// The measures of a part (see measures.h).
CagModelAnswer cag_answer_measure(CagSession *s, const char *script, const char *part);

// A picture that a page asks for.
typedef struct CagPictureRequest {
  char engine[16], quality[16], camera[128];
  int width, height;
  bool has_view;
  CagCameraView view;
} CagPictureRequest;
// Reads {"engine": "preview", "quality": "normal", "width": 960, "height": 540, "camera": CAMERA},
// where the camera is the name of one of the script, or a record of eye, target, up, and fov or
// width. Returns false if it is not an object.
bool cag_picture_request_read(const char *json, size_t size, CagPictureRequest *out);
// Renders to a PNG file.
CagModelAnswer cag_answer_picture(CagSession *s, const CagPictureRequest *request,
                                  void (*progress)(void *context, double percent,
                                                   const char *phase),
                                  void *context);

// What a page must know of its engine at first, as JSON.
typedef struct CagHello {
  const char *file, *folder, *engine;
  bool read_only, untitled, povray;
} CagHello;
void cag_hello_write(const CagHello *h, CagString *out);

#endif
