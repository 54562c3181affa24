// Writing EXR files.
//
// OpenEXRCore seeks back to write the table of chunk offsets into the header, which standard output
// does not support. So the compressed file is built in memory and then passed to an atomic file as
// a whole.

#include <openexr.h>
#include <stdint.h>
#include <string.h>

#include "base/array.h"
#include "base/atomic_file.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/render/exr.h"
#include "interp/render/exr_complaint.h"

// Names of up to this many bytes do not need the file's flag for long names.
#define SHORT_NAME_MAX 31

// The growing file, and the first error message of the library.
typedef struct {
  unsigned char *bytes;
  size_t size, capacity;
  const char *shown;
  CagExrComplaint complaint;
} Sink;

static int64_t sink_write(exr_const_context_t ctxt, void *user, const void *data, uint64_t n,
                          uint64_t offset, exr_stream_error_func_ptr_t error_cb) {
  Sink *sink = user;
  (void)error_cb;
  // The sum does not overflow: a picture has at most CAG_IMAGE_SAMPLES_MAX samples.
  const size_t end = (size_t)(offset + n);
  if (!CAG_RESERVE(sink->bytes, sink->capacity, end)) {
    cag_exr_complaint_keep(ctxt, EXR_ERR_OUT_OF_MEMORY,
                           "not enough memory for the compressed picture");
    return -1;
  }
  // The gap that the library leaves for the table of offsets is zero until it is filled.
  if (offset > sink->size) memset(sink->bytes + sink->size, 0, (size_t)offset - sink->size);
  memcpy(sink->bytes + offset, data, (size_t)n);
  if (end > sink->size) sink->size = end;
  return (int64_t)n;
}

static exr_result_t put_attribute(exr_context_t file, const CagExrAttribute *a) {
  switch (a->kind) {
  case CAG_EXR_TEXT: return exr_attr_set_string(file, 0, a->name, a->text);
  case CAG_EXR_NUMBER: return exr_attr_set_double(file, 0, a->name, a->number);
  case CAG_EXR_MATRIX: break;
  }
  exr_attr_m44f_t transposed;
  for (int r = 0; r < 4; r++)
    for (int c = 0; c < 4; c++) transposed.m[4 * c + r] = (float)a->matrix[4 * r + c];
  return exr_attr_set_m44f(file, 0, a->name, &transposed);
}

static exr_result_t write_header(exr_context_t file, const CagImage *image, CagExrPixels pixels,
                                 const CagExrMetadata *metadata) {
  int part;
  bool long_names = false;
  for (size_t c = 0; c < image->channel_count; c++)
    long_names |= strlen(image->channels[c].name) > SHORT_NAME_MAX;
  for (size_t i = 0; metadata && i < metadata->count; i++)
    long_names |= strlen(metadata->items[i].name) > SHORT_NAME_MAX;
  exr_result_t rv = exr_set_longname_support(file, long_names);
  if (!rv) rv = exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part);
  if (!rv)
    rv = exr_initialize_required_attr_simple(file, 0, (int32_t)image->width, (int32_t)image->height,
                                             EXR_COMPRESSION_ZIP);
  for (size_t c = 0; !rv && c < image->channel_count; c++)
    rv = exr_add_channel(file, 0, image->channels[c].name,
                         pixels == CAG_EXR_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                         EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  for (size_t i = 0; !rv && metadata && i < metadata->count; i++)
    rv = put_attribute(file, &metadata->items[i]);
  return rv ? rv : exr_write_header(file);
}

// Sets the encoder's channels, which are in the order of their names, to the rows from y on.
static exr_result_t aim_channels(exr_encode_pipeline_t *encoder, const CagImage *image, size_t y) {
  for (int16_t i = 0; i < encoder->channel_count; i++) {
    exr_coding_channel_info_t *to = &encoder->channels[i];
    size_t c;
    if (!cag_image_find(image, to->channel_name, &c)) return EXR_ERR_UNKNOWN;
    to->user_data_type = EXR_PIXEL_FLOAT;
    to->user_bytes_per_element = sizeof(float);
    to->user_pixel_stride = sizeof(float);
    to->user_line_stride = (int32_t)(image->width * sizeof(float));
    to->encode_from_ptr = (const uint8_t *)(cag_image_plane(image, c) + y * image->width);
  }
  return EXR_ERR_SUCCESS;
}

static exr_result_t write_chunks(exr_context_t file, const CagImage *image) {
  int32_t lines = 0;
  exr_result_t rv = exr_get_scanlines_per_chunk(file, 0, &lines);
  exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
  bool begun = false;
  for (size_t y = 0; !rv && y < image->height; y += (size_t)lines) {
    exr_chunk_info_t chunk;
    if (cag_stopped()) rv = EXR_ERR_UNKNOWN;
    if (!rv) rv = exr_write_scanline_chunk_info(file, 0, (int)y, &chunk);
    if (!rv)
      rv = begun ? exr_encoding_update(file, 0, &chunk, &encoder)
                 : exr_encoding_initialize(file, 0, &chunk, &encoder);
    if (!rv) rv = aim_channels(&encoder, image, y);
    if (!rv && !begun) rv = exr_encoding_choose_default_routines(file, 0, &encoder);
    begun = begun || !rv;
    if (!rv) rv = exr_encoding_run(file, 0, &encoder);
  }
  if (begun) exr_encoding_destroy(file, &encoder);
  return rv;
}

static bool check_names(const char *path, const CagImage *image, CagError *err) {
  for (size_t c = 0; c < image->channel_count; c++) {
    size_t first = c;
    const char *name = image->channels[c].name;
    if (!*name)
      return cag_fail_io(err, CAG_E_USAGE, "name every channel",
                         "cannot write '%s': channel %zu has no name", path, c);
    cag_image_find(image, name, &first);
    if (first != c)
      return cag_fail_io(err, CAG_E_USAGE, "give each channel its own name",
                         "cannot write '%s': two channels are named '%s'", path, name);
  }
  return true;
}

// Compresses the picture into the sink.
static bool encode(Sink *sink, const CagImage *image, CagExrPixels pixels,
                   const CagExrMetadata *metadata, CagError *err) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = cag_exr_complaint_keep;
  setup.user_data = sink;
  setup.write_fn = sink_write;
  cag_exr_complaint_listen(&sink->complaint);
  exr_context_t file = NULL;
  exr_result_t rv = exr_start_write(&file, sink->shown, EXR_WRITE_FILE_DIRECTLY, &setup);
  if (!rv) rv = write_header(file, image, pixels, metadata);
  if (!rv) rv = write_chunks(file, image);
  if (file) {
    exr_result_t finished = exr_finish(&file);
    if (!rv) rv = finished;
  }
  cag_exr_complaint_listen(NULL);
  if (rv == EXR_ERR_SUCCESS) return true;
  if (cag_stopped()) return cag_fail_io(err, CAG_E_CALLBACK, NULL, "writing was stopped");
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot write '%s' as EXR: %s", sink->shown,
                     cag_exr_complaint_text(&sink->complaint, rv));
}

bool cag_exr_write(const char *path, const CagImage *image, CagExrPixels pixels,
                   const CagExrMetadata *metadata, CagError *err) {
  if (!check_names(path, image, err)) return false;
  // Opened first, to report an unwritable path before the compression.
  CagAtomicFile *out = cag_atomic_file_open(path, err);
  if (!out) return false;
  Sink sink = {.shown = path};
  bool ok = encode(&sink, image, pixels, metadata, err);
  if (ok) {
    cag_atomic_file_write(out, sink.bytes, sink.size);
    ok = cag_atomic_file_commit(out, err);
  } else {
    cag_atomic_file_abort(out);
  }
  cag_free(sink.bytes);
  return ok;
}

bool cag_exr_rewrite(const void *bytes, size_t size, const char *shown, const char *path,
                     const CagExrMetadata *metadata, CagImage *picture, CagError *err) {
  CagImage image;
  bool all_half;
  if (!cag_exr_read_pixels(bytes, size, shown, &image, NULL, &all_half, err)) return false;
  bool ok = cag_exr_write(path, &image, all_half ? CAG_EXR_HALF : CAG_EXR_FLOAT, metadata, err);
  if (ok && picture) *picture = image;
  else cag_image_free(&image);
  return ok;
}
