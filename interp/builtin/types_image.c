// The type of images.

#include <math.h>
#include <string.h>

#include "geom/image/arithmetic.h"
#include "interp/builtin/types.h"
#include "interp/vm/jet.h"
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

// --- Operators ---

static bool raster_op(CagBinaryOp op, CagRasterOp *out) {
  switch (op) {
  case CAG_OP_ADD: *out = CAG_RASTER_ADD; return true;
  case CAG_OP_SUBTRACT: *out = CAG_RASTER_SUBTRACT; return true;
  case CAG_OP_MULTIPLY: *out = CAG_RASTER_MULTIPLY; return true;
  case CAG_OP_DIVIDE: *out = CAG_RASTER_DIVIDE; return true;
  default: return false;
  }
}

static CagStatus combine(CagRasterOp op, CagValue a, CagValue b, CagRaster **out, CagError *err) {
  if (a.type != CAG_IMAGE)
    return cag_raster_with_number(op, CAG_AS_IMAGE(b)->raster, a.as.number, true, out, err);
  if (b.type != CAG_IMAGE)
    return cag_raster_with_number(op, CAG_AS_IMAGE(a)->raster, b.as.number, false, out, err);
  return cag_raster_combine(op, CAG_AS_IMAGE(a)->raster, CAG_AS_IMAGE(b)->raster, out, err);
}

// Two images, or an image and a number.
static bool image_arithmetic(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result,
                             bool *known) {
  CagRasterOp raster;
  CagRaster *made;
  CagError err = {0};
  a = cag_plain(a);
  b = cag_plain(b);
  *known = (a.type == CAG_IMAGE || a.type == CAG_NUMBER) &&
           (b.type == CAG_IMAGE || b.type == CAG_NUMBER) && raster_op(op, &raster);
  if (!*known) return false;
  if (op == CAG_OP_DIVIDE && b.type == CAG_NUMBER && b.as.number == 0)
    return cag_vm_fail(vm, CAG_ERR_not_finite, "division of an image by 0");
  const CagStatus status = combine(raster, a, b, &made, &err);
  if (status == CAG_E_MEMORY) cag_vm_out_of_memory(vm);
  if (status == CAG_E_CALLBACK) return cag_stop_answer(vm);
  if (status) return cag_vm_fail(vm, err.id, "%s", err.message);
  *result = cag_image_value(vm, made);
  return true;
}

// --- The row of the type ---

static void scan_image(CagHeap *h, CagObject *o) {
  const CagImageValue *v = (CagImageValue *)o;
  if (v->name) cag_mark_object(h, &v->name->head);
  if (v->parts) cag_mark_object(h, &v->parts->head);
}
static void retain_image(CagObject *o) { cag_raster_retain(((CagImageValue *)o)->raster); }
static void destroy_image(CagObject *o) { cag_raster_release(((CagImageValue *)o)->raster); }

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
                                     .arithmetic = image_arithmetic,
                                     .destroy = destroy_image,
                                     .member = image_member,
                                     .member_name = image_member_name};
