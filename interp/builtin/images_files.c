// Images from files.

#include <string.h>

#include "geom/image/layout.h"
#include "interp/builtin/images.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/formats/raster_file.h"
#include "interp/vm/vm.h"

// Makes the error of the script of an error of files.
static bool fail_file(CagCall *call, const CagError *err) {
  if (err->status == CAG_E_MEMORY) cag_vm_out_of_memory(call->vm);
  if (err->status == CAG_E_CALLBACK) return cag_stop_answer(call->vm);
  cag_fail_call(call, 0, err->status == CAG_E_LIMIT ? CAG_ERR_image_size : CAG_ERR_image_file, "%s",
                err->message);
  return err->help[0] && cag_fail_help(call->vm, "%s", err->help);
}

// The channels with the names of a list, as an image of its own.
static bool select_channels(CagCall *call, const CagRaster *r, CagValue *result) {
  CagList *names;
  CagRaster *made = NULL;
  if (!cag_arg_list(call, 1, &names)) return false;
  size_t *channels = cag_hold_array(call, names->length, sizeof *channels);
  for (size_t i = 0; i < names->length; i++) {
    const CagValue name = cag_list_get(call->vm, names, i);
    if (name.type != CAG_TEXT || !cag_text_is_c(CAG_AS_TEXT(name)))
      return cag_fail_element(call, 1, i, name, "texts");
    if (!cag_channel_find(call, 1, r, CAG_AS_TEXT(name)->bytes, &channels[i])) return false;
    for (size_t k = 0; k < i; k++)
      if (channels[k] == channels[i])
        return cag_fail_call(call, 1, CAG_ERR_image_channels,
                             "expects different names, found \"%s\" twice",
                             CAG_AS_TEXT(name)->bytes);
  }
  return cag_raster_result(call, cag_raster_select(r, channels, names->length, &made, call->err),
                           &made, result);
}

bool cag_images_read_image(CagCall *call, const struct cag_images_read_image *a, CagValue *result) {
  char *bytes;
  size_t size;
  CagRaster *r;
  if (!cag_vm_open_file(call, 0, a->path, &bytes, &size)) return false;
  cag_hold(call, bytes);
  if (!cag_raster_read(bytes, size, a->path, &r, call->err)) return fail_file(call, call->err);
  cag_release_held(call, bytes); // before the image has its value
  cag_hold_raster(call, r);
  if (cag_given(call, 1)) return select_channels(call, r, result);
  *result = cag_image_result(call, r);
  return true;
}
