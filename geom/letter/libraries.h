// HarfBuzz, which reads fonts and shapes texts, and FriBidi, which orders texts of both directions.
// They are loaded when the first text is set (base/library).

#ifndef CAG_GEOM_LETTER_LIBRARIES_H
#define CAG_GEOM_LETTER_LIBRARIES_H

#include <fribidi.h>
#include <hb.h>

#include "base/status.h"

#define CAG_HARFBUZZ_FUNCTIONS(X)                                                                  \
  X(blob_create)                                                                                   \
  X(blob_destroy)                                                                                  \
  X(blob_get_length)                                                                               \
  X(buffer_add_codepoints)                                                                         \
  X(buffer_allocation_successful)                                                                  \
  X(buffer_clear_contents)                                                                         \
  X(buffer_create)                                                                                 \
  X(buffer_destroy)                                                                                \
  X(buffer_get_glyph_infos)                                                                        \
  X(buffer_get_glyph_positions)                                                                    \
  X(buffer_set_direction)                                                                          \
  X(buffer_set_flags)                                                                              \
  X(buffer_set_language)                                                                           \
  X(buffer_set_script)                                                                             \
  X(draw_funcs_create)                                                                             \
  X(draw_funcs_destroy)                                                                            \
  X(draw_funcs_set_close_path_func)                                                                \
  X(draw_funcs_set_cubic_to_func)                                                                  \
  X(draw_funcs_set_line_to_func)                                                                   \
  X(draw_funcs_set_move_to_func)                                                                   \
  X(draw_funcs_set_quadratic_to_func)                                                              \
  X(face_count)                                                                                    \
  X(face_create)                                                                                   \
  X(face_destroy)                                                                                  \
  X(face_get_glyph_count)                                                                          \
  X(face_get_upem)                                                                                 \
  X(face_reference_table)                                                                          \
  X(font_create)                                                                                   \
  X(font_destroy)                                                                                  \
  X(font_get_glyph_h_advance)                                                                      \
  X(font_get_glyph_shape)                                                                          \
  X(font_get_glyph_v_advance)                                                                      \
  X(font_get_h_extents)                                                                            \
  X(font_get_nominal_glyph)                                                                        \
  X(font_set_scale)                                                                                \
  X(language_from_string)                                                                          \
  X(shape)                                                                                         \
  X(unicode_funcs_get_default)                                                                     \
  X(unicode_script)

#define CAG_FRIBIDI_FUNCTIONS(X)                                                                   \
  X(get_bidi_types)                                                                                \
  X(get_bracket_types)                                                                             \
  X(get_par_embedding_levels_ex)                                                                   \
  X(reorder_line)

typedef struct CagHarfbuzz {
#define X(name) __typeof__(hb_##name) *name;
  CAG_HARFBUZZ_FUNCTIONS(X)
#undef X
} CagHarfbuzz;

typedef struct CagFribidi {
#define X(name) __typeof__(fribidi_##name) *name;
  CAG_FRIBIDI_FUNCTIONS(X)
#undef X
} CagFribidi;

extern CagHarfbuzz cag_hb;
extern CagFribidi cag_fribidi;

// Loads both if they are not yet loaded. Fails with "library-missing". Any thread may call it.
CagStatus cag_letter_libraries(CagError *err);

#endif
