// The type of images.

#include <string.h>

#include "interp/builtin/types.h"
#include "interp/vm/vm.h"

// "image, 640 x 480, channels r, g, b"
static void print_image(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagRaster *r = CAG_AS_IMAGE(v)->raster;
  cag_string_printf(s, "image, %zu x %zu", r->width, r->height);
  if (r->channel_count == 1 && !*r->names[0]) return;
  cag_string_printf(s, ", channel%s ", r->channel_count == 1 ? "" : "s");
  for (size_t c = 0; c < r->channel_count; c++)
    cag_string_printf(s, "%s%s", c ? ", " : "", r->names[c]);
}

// Pixels without a value are equal to each other.
static bool equal_samples(const double *a, const double *b, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (a[i] != b[i] && (a[i] == a[i] || b[i] == b[i])) return false;
  return true;
}

static bool equal_images(CagVm *vm, CagValue a, CagValue b) {
  (void)vm;
  const CagRaster *p = CAG_AS_IMAGE(a)->raster, *q = CAG_AS_IMAGE(b)->raster;
  if (p->width != q->width || p->height != q->height || p->channel_count != q->channel_count)
    return false;
  for (size_t c = 0; c < p->channel_count; c++)
    if (strcmp(p->names[c], q->names[c]) != 0) return false;
  return equal_samples(p->data, q->data, p->width * p->height * p->channel_count);
}

static void retain_image(CagObject *o) { cag_raster_retain(((CagImageValue *)o)->raster); }
static void destroy_image(CagObject *o) { cag_raster_release(((CagImageValue *)o)->raster); }

static void scan_image(CagHeap *h, CagObject *o) {
  const CagImageValue *v = (CagImageValue *)o;
  if (v->parts) cag_mark_object(h, &v->parts->head);
}

static const char *const members[] = {"width", "height", "channels", "parts", NULL};

static bool image_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  const CagRaster *r = CAG_AS_IMAGE(v)->raster;
  if (!strcmp(name, members[0])) *out = cag_number((double)r->width);
  else if (!strcmp(name, members[1])) *out = cag_number((double)r->height);
  else if (!strcmp(name, members[2])) {
    CagBuilder *names = cag_builder_new(vm);
    for (size_t c = 0; c < r->channel_count; c++)
      if (!cag_builder_add(vm, names, cag_text_c(vm, r->names[c]))) return false;
    *out = cag_builder_finish(vm, names);
  } else if (!strcmp(name, members[3]) && CAG_AS_IMAGE(v)->parts)
    *out = cag_object(CAG_LIST, CAG_AS_IMAGE(v)->parts);
  else return false;
  return true;
}

static const char *image_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm;
  return i == 3 && !CAG_AS_IMAGE(v)->parts ? NULL : cag_name_at(members, i);
}

const CagValueType cag_type_image = {.print = print_image,
                                     .equal = equal_images,
                                     .scan = scan_image,
                                     .retain = retain_image,
                                     .destroy = destroy_image,
                                     .member = image_member,
                                     .member_name = image_member_name};
