// EXR files, the reading side.
//
// The file is read into memory first: then no length can change under the decoder, and standard
// input is like a file. The library's header checks are strict, its repair of files without a chunk
// table is off: a damaged picture is an error, not a guess.

#include <errno.h>
#include <fcntl.h>
#include <openexr.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interp/render/exr.h"

// Largest file taken into memory: an uncompressed float picture of CAG_IMAGE_SAMPLES_MAX and its
// header fit.
#define FILE_SIZE_MAX (((size_t)1 << 32) + ((size_t)1 << 24))
// A first block for inputs of unknown length (pipes).
#define PIPE_BLOCK ((size_t)1 << 20)
// The four bytes that every EXR begins with.
static const unsigned char MAGIC[4] = {0x76, 0x2f, 0x31, 0x01};

// The bytes, and the first complaint of the library.
typedef struct {
  const unsigned char *bytes;
  size_t size;
  const char *shown;
  char complaint[256];
} Source;

static bool fail(CagIoError *err, const Source *source, const char *what) {
  return cag_io_error_set(err, CAG_EXIT_FILE, NULL, "cannot read '%s' as EXR: %s", source->shown,
                          what);
}

static bool fail_code(CagIoError *err, const Source *source, exr_result_t code) {
  if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
    return cag_io_error_set(
        err, CAG_EXIT_FILE, "store it with ZIP, PIZ, RLE or no compression",
        "cannot read '%s' as EXR: its compression is not one that this build of "
        "OpenEXRCore decodes",
        source->shown);
  return fail(err, source,
              source->complaint[0] ? source->complaint : exr_get_default_error_message(code));
}

// The library's messages may begin with the file's name, which ours say already.
static void keep_complaint(exr_const_context_t ctxt, exr_result_t code, const char *message) {
  void *user = NULL;
  (void)code;
  if (!ctxt || exr_get_user_data(ctxt, &user) != EXR_ERR_SUCCESS || !user) return;
  Source *source = user;
  if (source->complaint[0] || !message) return;
  size_t named = strlen(source->shown);
  if (!strncmp(message, source->shown, named) && !strncmp(message + named, ": ", 2))
    message += named + 2;
  snprintf(source->complaint, sizeof source->complaint, "%s", message);
}

static int64_t source_read(exr_const_context_t ctxt, void *user, void *buffer, uint64_t n,
                           uint64_t offset, exr_stream_error_func_ptr_t error_cb) {
  const Source *source = user;
  (void)ctxt, (void)error_cb;
  // Like pread, gives what there is: the library reads ahead over a short file's end, and checks
  // where it needs all.
  if (offset >= source->size) return 0;
  if (n > source->size - offset) n = source->size - offset;
  memcpy(buffer, source->bytes + offset, (size_t)n);
  return (int64_t)n;
}

static int64_t source_size(exr_const_context_t ctxt, void *user) {
  (void)ctxt;
  return (int64_t)((const Source *)user)->size;
}

// One part of the file while it is decoded into planes first_channel ... of the image.
typedef struct {
  exr_context_t file;
  int part;
  const CagImage *image;
  size_t first_channel;
  exr_attr_box2i_t data, display;
  int lines; // scanlines in a chunk
  bool begun;
  exr_decode_pipeline_t decoder;
  float *scratch; // one chunk of all channels
  size_t scratch_samples;
} PartReader;

// Places of the samples of one chunk: aims the decoder's channels at the scratch memory.
static exr_result_t aim_channels(PartReader *r) {
  size_t total = 0;
  for (int16_t i = 0; i < r->decoder.channel_count; i++) {
    const exr_coding_channel_info_t *c = &r->decoder.channels[i];
    if (c->width < 0 || c->height < 0) return EXR_ERR_CORRUPT_CHUNK;
    total += (size_t)c->width * (size_t)c->height;
  }
  if (total > CAG_IMAGE_SAMPLES_MAX) return EXR_ERR_OUT_OF_MEMORY;
  if (total > r->scratch_samples) {
    free(r->scratch);
    r->scratch = malloc(total * sizeof *r->scratch);
    r->scratch_samples = r->scratch ? total : 0;
    if (!r->scratch) return EXR_ERR_OUT_OF_MEMORY;
  }
  float *at = r->scratch;
  for (int16_t i = 0; i < r->decoder.channel_count; i++) {
    exr_coding_channel_info_t *c = &r->decoder.channels[i];
    // Whole numbers are decoded as such and converted here; half becomes float in the library.
    c->user_data_type = c->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    c->user_bytes_per_element = sizeof(float);
    c->user_pixel_stride = sizeof(float);
    c->user_line_stride = c->width * (int32_t)sizeof(float);
    c->decode_to_ptr = c->width && c->height ? (uint8_t *)at : NULL;
    at += (size_t)c->width * (size_t)c->height;
  }
  return EXR_ERR_SUCCESS;
}

// A decoded sample as a float.
static float sample(const exr_coding_channel_info_t *c, size_t index) {
  const uint8_t *from = c->decode_to_ptr + index * sizeof(float);
  float value;
  uint32_t whole;
  if (c->data_type == EXR_PIXEL_UINT) {
    memcpy(&whole, from, sizeof whole);
    return (float)whole;
  }
  memcpy(&value, from, sizeof value);
  return value;
}

static int64_t clamp(int64_t i, int64_t least, int64_t most) {
  return i < least ? least : i > most ? most : i;
}

// Copies the decoded samples of channel `c` of a chunk that covers the file's pixels from (x0, y0),
// w by h of them, into its plane, as far as they are in the display window. The chunk's samples
// begin at the first multiple of the sampling.
static void copy_channel(const PartReader *r, const exr_coding_channel_info_t *c, float *plane,
                         int64_t x0, int64_t y0, int64_t w, int64_t h) {
  if (!c->decode_to_ptr) return;
  const int64_t xs = c->x_samples > 0 ? c->x_samples : 1, ys = c->y_samples > 0 ? c->y_samples : 1;
  const int64_t left = r->display.min.x, top = r->display.min.y;
  const int64_t x_begin = x0 > left ? x0 : left, y_begin = y0 > top ? y0 : top;
  const int64_t x_end = clamp(x0 + w, x_begin, left + (int64_t)r->image->width);
  const int64_t y_end = clamp(y0 + h, y_begin, top + (int64_t)r->image->height);
  const bool plain =
      xs == 1 && ys == 1 && c->data_type != EXR_PIXEL_UINT && c->width == w && c->height == h;
  for (int64_t y = y_begin; y < y_end && x_begin < x_end; y++) {
    float *to = plane + (size_t)(y - top) * r->image->width + (size_t)(x_begin - left);
    const int64_t row = clamp((y - y0) / ys, 0, c->height - 1) * c->width;
    if (plain) {
      memcpy(to, c->decode_to_ptr + (size_t)(row + x_begin - x0) * sizeof(float),
             (size_t)(x_end - x_begin) * sizeof(float));
      continue;
    }
    for (int64_t x = x_begin; x < x_end; x++)
      *to++ = sample(c, (size_t)(row + clamp((x - x0) / xs, 0, c->width - 1)));
  }
}

// Decodes one chunk, whose upper left pixel is (x0, y0).
static exr_result_t read_chunk(PartReader *r, const exr_chunk_info_t *chunk, int64_t x0,
                               int64_t y0) {
  exr_result_t rv = r->begun ? exr_decoding_update(r->file, r->part, chunk, &r->decoder)
                             : exr_decoding_initialize(r->file, r->part, chunk, &r->decoder);
  if (rv) return rv;
  const bool first = !r->begun;
  r->begun = true;
  rv = aim_channels(r);
  if (!rv && first) rv = exr_decoding_choose_default_routines(r->file, r->part, &r->decoder);
  if (!rv) rv = exr_decoding_run(r->file, r->part, &r->decoder);
  for (int16_t i = 0; !rv && i < r->decoder.channel_count; i++)
    copy_channel(r, &r->decoder.channels[i],
                 cag_image_plane(r->image, r->first_channel + (size_t)i), x0, y0, chunk->width,
                 chunk->height);
  return rv;
}

static exr_result_t read_scanlines(PartReader *r) {
  int32_t lines = 0;
  exr_result_t rv = exr_get_scanlines_per_chunk(r->file, r->part, &lines);
  if (!rv && lines < 1) rv = EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = r->data.min.y; !rv && y <= r->data.max.y; y += lines) {
    exr_chunk_info_t chunk;
    rv = exr_read_scanline_chunk_info(r->file, r->part, (int)y, &chunk);
    if (!rv) rv = read_chunk(r, &chunk, r->data.min.x, y);
  }
  return rv;
}

static exr_result_t read_tiles(PartReader *r) {
  int32_t tile_w = 0, tile_h = 0;
  exr_result_t rv = exr_get_tile_sizes(r->file, r->part, 0, 0, &tile_w, &tile_h);
  if (!rv && (tile_w < 1 || tile_h < 1)) rv = EXR_ERR_CORRUPT_CHUNK;
  if (rv) return rv;
  const int64_t width = (int64_t)r->data.max.x - r->data.min.x + 1;
  const int64_t height = (int64_t)r->data.max.y - r->data.min.y + 1;
  for (int64_t ty = 0; !rv && ty * tile_h < height; ty++) {
    for (int64_t tx = 0; !rv && tx * tile_w < width; tx++) {
      exr_chunk_info_t chunk;
      rv = exr_read_tile_chunk_info(r->file, r->part, (int)tx, (int)ty, 0, 0, &chunk);
      if (!rv) rv = read_chunk(r, &chunk, r->data.min.x + tx * tile_w, r->data.min.y + ty * tile_h);
    }
  }
  return rv;
}

static exr_result_t read_part(exr_context_t file, int part, size_t first_channel,
                              const exr_attr_box2i_t *display, const CagImage *image) {
  PartReader r = {.file = file,
                  .part = part,
                  .image = image,
                  .first_channel = first_channel,
                  .display = *display,
                  .decoder = EXR_DECODE_PIPELINE_INITIALIZER};
  exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
  exr_result_t rv = exr_get_storage(file, part, &storage);
  if (!rv) rv = exr_get_data_window(file, part, &r.data);
  if (!rv) rv = storage == EXR_STORAGE_TILED ? read_tiles(&r) : read_scanlines(&r);
  if (r.begun) exr_decoding_destroy(file, &r.decoder);
  free(r.scratch);
  return rv;
}

// The name of a channel in the image; see the header for the rule.
static void name_channel(CagImage *image, size_t c, exr_context_t file, int part,
                         const char *channel) {
  const char *name = NULL;
  if (part == 0 || exr_get_name(file, part, &name) != EXR_ERR_SUCCESS || !name) {
    cag_image_set_name(image, c, channel);
    return;
  }
  char full[2 * CAG_IMAGE_NAME_MAX + 2];
  size_t length = strlen(name);
  bool prefixed = !strncmp(channel, name, length) && channel[length] == '.';
  snprintf(full, sizeof full, "%.*s%s%.*s", prefixed ? 0 : CAG_IMAGE_NAME_MAX, name,
           prefixed ? "" : ".", CAG_IMAGE_NAME_MAX, channel);
  cag_image_set_name(image, c, full);
}

// Checks every part and counts the channels of all.
static bool survey(exr_context_t file, const Source *source, int parts, size_t *channels,
                   bool *all_half, CagIoError *err) {
  *channels = 0;
  *all_half = true;
  for (int p = 0; p < parts; p++) {
    exr_storage_t storage;
    const exr_attr_chlist_t *list;
    exr_result_t rv = exr_get_storage(file, p, &storage);
    if (!rv) rv = exr_get_channels(file, p, &list);
    if (rv) return fail_code(err, source, rv);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
      return fail(err, source, "it holds deep data (several samples per pixel)");
    for (int i = 0; i < list->num_channels; i++)
      *all_half &= list->entries[i].pixel_type == EXR_PIXEL_HALF;
    if (list->num_channels < 1) return fail(err, source, "a part has no channels");
    *channels += (size_t)list->num_channels;
  }
  return true;
}

// Takes the facts of the header that the list can hold.
static bool read_metadata(exr_context_t file, CagExrMetadata *out, CagIoError *err) {
  int32_t count = 0;
  if (exr_get_attribute_count(file, 0, &count) != EXR_ERR_SUCCESS) return true;
  bool ok = true;
  for (int32_t i = 0; ok && i < count; i++) {
    const exr_attribute_t *a;
    if (exr_get_attribute_by_index(file, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a) != EXR_ERR_SUCCESS)
      continue;
    if (!a->name || !a->name[0] || cag_exr_name_is_reserved(a->name)) continue;
    double matrix[16];
    switch (a->type) {
    case EXR_ATTR_STRING:
      ok = cag_exr_metadata_text(out, a->name, a->string->str ? a->string->str : "", err);
      break;
    case EXR_ATTR_INT: ok = cag_exr_metadata_number(out, a->name, a->i, err); break;
    case EXR_ATTR_FLOAT: ok = cag_exr_metadata_number(out, a->name, a->f, err); break;
    case EXR_ATTR_DOUBLE: ok = cag_exr_metadata_number(out, a->name, a->d, err); break;
    case EXR_ATTR_M44F:
    case EXR_ATTR_M44D:
      for (int k = 0; k < 16; k++) {
        int from = 4 * (k % 4) + k / 4;
        matrix[k] = a->type == EXR_ATTR_M44F ? (double)a->m44f->m[from] : a->m44d->m[from];
      }
      ok = cag_exr_metadata_matrix(out, a->name, matrix, err);
      break;
    default: break;
    }
  }
  return ok;
}

static bool read_open(exr_context_t file, const Source *source, CagImage *out, bool *all_half,
                      CagIoError *err) {
  int parts = 0;
  exr_attr_box2i_t display;
  exr_result_t rv = exr_get_count(file, &parts);
  if (!rv) rv = exr_get_display_window(file, 0, &display);
  if (rv) return fail_code(err, source, rv);
  size_t channels;
  if (!survey(file, source, parts, &channels, all_half, err)) return false;

  int64_t width = (int64_t)display.max.x - display.min.x + 1;
  int64_t height = (int64_t)display.max.y - display.min.y + 1;
  if (width < 1 || height < 1) return fail(err, source, "its display window is empty");
  CagIoError inner;
  if (!cag_image_create(out, (size_t)width, (size_t)height, channels, &inner))
    return cag_io_error_set(err, inner.exit_status, inner.help, "cannot read '%s' as EXR: %.300s",
                            source->shown, inner.message);

  size_t next = 0;
  for (int p = 0; !rv && p < parts; p++) {
    const exr_attr_chlist_t *list;
    rv = exr_get_channels(file, p, &list);
    if (rv) break;
    for (int i = 0; i < list->num_channels; i++)
      name_channel(out, next + (size_t)i, file, p, list->entries[i].name.str);
    rv = read_part(file, p, next, &display, out);
    next += (size_t)list->num_channels;
  }
  if (!rv) return true;
  cag_image_free(out);
  return fail_code(err, source, rv);
}

bool cag_exr_read_pixels(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, bool *all_half, CagIoError *err) {
  Source source = {.bytes = bytes, .size = size, .shown = shown};
  if (!size) return fail(err, &source, "the file is empty");
  if (size < sizeof MAGIC || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
    return fail(err, &source, "it is not an EXR file (its first bytes are not those of one)");
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = keep_complaint;
  setup.user_data = &source;
  setup.read_fn = source_read;
  setup.size_fn = source_size;
  setup.max_image_width = setup.max_image_height = (int)CAG_IMAGE_SIDE_MAX;
  setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  exr_context_t file = NULL;
  exr_result_t rv = exr_start_read(&file, shown, &setup);
  if (rv) {
    if (file) exr_finish(&file);
    return fail_code(err, &source, rv);
  }
  bool ok = read_open(file, &source, out, all_half, err);
  if (ok && metadata && !read_metadata(file, metadata, err)) {
    cag_image_free(out);
    ok = false;
  }
  exr_finish(&file);
  return ok;
}

bool cag_exr_read_memory(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, CagIoError *err) {
  bool all_half;
  return cag_exr_read_pixels(bytes, size, shown, out, metadata, &all_half, err);
}

static bool fail_file(CagIoError *err, const char *shown, const char *why) {
  return cag_io_error_set(err, CAG_EXIT_FILE, NULL, "cannot read '%s': %s", shown, why);
}

// Reads everything from an open file; its size is only a first guess.
static bool slurp(int fd, const char *shown, unsigned char **bytes, size_t *size, CagIoError *err) {
  struct stat st;
  if (fstat(fd, &st) != 0) return fail_file(err, shown, strerror(errno));
  if (S_ISDIR(st.st_mode)) return fail_file(err, shown, "it is a folder");
  size_t capacity = st.st_size > 0 ? (size_t)st.st_size + 1 : PIPE_BLOCK;
  *bytes = NULL;
  *size = 0;
  for (;;) {
    if (*size > FILE_SIZE_MAX || capacity > 2 * FILE_SIZE_MAX)
      return fail_file(err, shown, "the file is too large");
    unsigned char *larger = realloc(*bytes, capacity);
    if (!larger) return fail_file(err, shown, "no memory for the file");
    *bytes = larger;
    while (*size < capacity) {
      ssize_t n = read(fd, *bytes + *size, capacity - *size);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return fail_file(err, shown, strerror(errno));
      if (n == 0) return true;
      *size += (size_t)n;
    }
    capacity *= 2;
  }
}

bool cag_exr_read(const char *path, CagImage *out, CagExrMetadata *metadata, CagIoError *err) {
  const bool standard_input = !strcmp(path, "-");
  const char *shown = standard_input ? "standard input" : path;
  int fd = standard_input ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) return fail_file(err, shown, strerror(errno));
  unsigned char *bytes = NULL;
  size_t size = 0;
  bool ok = slurp(fd, shown, &bytes, &size, err) &&
            cag_exr_read_memory(bytes, size, shown, out, metadata, err);
  free(bytes);
  if (!standard_input) close(fd);
  return ok;
}
