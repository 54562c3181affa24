// Documents: text with possible line breaks, and a printer for them.
//
// The method is that of Wadler ("A prettier printer", 2003): a document is text, a possible line
// break, or a combination of documents. The printer prints each group on one line if it fits, and
// breaks its lines otherwise. Each document stores its width on one line and its width up to the
// first possible break, so that each decision is local. Comments at the ends of neighboring lines
// are aligned. Line breaks are lazy: one is printed before the next text, so that adjacent breaks
// are merged, and a comment can still be added to the end of the line. All documents live until the
// next cag_layout_print. If memory runs out, control returns to the guard (base/guard.h).

#ifndef CAG_LANG_LAYOUT_H
#define CAG_LANG_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/source.h"

typedef enum DocKind {
  DOC_TEXT,
  DOC_LINE,     // text (a space, or empty) if on one line, else a line break
  DOC_HARD,     // always a line break
  DOC_BLANK,    // makes the next line break leave an empty line
  DOC_TRAILING, // a comment at the end of the line
  DOC_COMMENT,  // a comment on a separate line
  DOC_INLINE,   // a comment within the line, preceded by a space
  DOC_CONCAT,   // its lines break with those of its parent
  DOC_NEST,     // likewise, with indentation
  DOC_GROUP,    // on one line, or with all its lines broken
  DOC_STAGES,   // a head and the rest: on one line; or with the head broken, and the rest after its
                // closing bracket; or as a group
  DOC_FILL,     // a line is broken only if the next item does not fit; lines after the first are
                // indented
  DOC_BRACKETS, // items between brackets: on one line, or one per line
  DOC_FILLED,   // items between brackets: on one line, or filled
  DOC_TABLE     // rows of words between brackets: on one line, or one per line, with aligned words
} DocKind;

// A width that never fits, for a forced break.
#define DOC_ENDLESS ((uint32_t)1 << 28)

typedef struct Doc Doc;
struct Doc {
  uint8_t kind;   // DocKind
  bool breaks;    // contains a possible break
  bool comma;     // is followed by a comma, which both widths include
  bool hugs;      // BRACKETS: the last item may start on the line of the bracket
  bool opens;     // BRACKETS: the first item may start on the line of the bracket, with a short
                  // rest after it
  bool gathers;   // BRACKETS: if broken, all items may be on one line
  bool padded;    // BRACKETS: on one line, with spaces inside
  char bracket;   // BRACKETS: the opening one
  uint32_t width; // on one line; DOC_ENDLESS: impossible
  uint32_t first; // up to the first possible break
  union {
    uint32_t length; // TEXT, LINE
    int indent;      // NEST, FILL, BRACKETS
  };
  union {
    const char *text; // TEXT, LINE
    Doc *child;
  };
  union {
    Doc *close;   // BRACKETS
    uint32_t pad; // a word of a TABLE: columns before it that align its end
  };
  Doc *next; // next one in the same parent
};

typedef struct Docs {
  Doc *head, *tail;
} Docs;

typedef struct LayoutBlock LayoutBlock;
typedef struct LayoutTrailing {
  size_t at; // end of the code in the output, where the comment starts
  size_t line;
  uint32_t column, indent; // of the code
} LayoutTrailing;

typedef struct Layout {
  const CagSource *source; // being formatted
  uint32_t width;
  LayoutBlock *blocks, *block; // memory of documents; the block in use
  char *out;
  size_t length, capacity;
  size_t line;
  uint32_t column, indent;
  bool pending, blank; // a line break is pending, and leaves an empty line
  bool closed;         // the line ends with a comment
  int pending_indent;
  LayoutTrailing *trailing; // comments of neighboring lines that are not aligned yet
  size_t trailing_count, trailing_capacity;
} Layout;

void cag_layout_init(Layout *l, const CagSource *source, uint32_t width);
// Allocates memory that lives as long as the documents.
void *cag_layout_memory(Layout *l, size_t size);

static inline void layout_add(Docs *list, Doc *d) {
  if (list->tail) list->tail->next = d;
  else list->head = d;
  list->tail = d;
}
Doc *cag_layout_text(Layout *l, const char *text, size_t length); // borrowed; may contain line
                                                                  // breaks
// A word of ASCII without line breaks, borrowed.
Doc *cag_layout_plain(Layout *l, const char *word, size_t length);
Doc *cag_layout_space(Layout *l); // a LINE that is a space on one line
Doc *cag_layout_hard(Layout *l);
Doc *cag_layout_blank(Layout *l);
Doc *cag_layout_trailing(Layout *l, Doc *text);
Doc *cag_layout_comment(Layout *l, Doc *text);
Doc *cag_layout_inline(Layout *l, Doc *text);
Doc *cag_layout_concat(Layout *l, const Docs *parts);
void cag_layout_comma(Doc *d); // adds a comma after it
Doc *cag_layout_group(Layout *l, Doc *d);
Doc *cag_layout_stages(Layout *l, Doc *head, Doc *rest);
Doc *cag_layout_nest(Layout *l, int indent, const Docs *parts);
Doc *cag_layout_fill(Layout *l, int indent, const Docs *items); // alternating items and LINEs
// `items`: alternating items and LINEs. `hugs`: if all but the last item fit, the last one may
// start on the same line, and its own brackets close together with these.
Doc *cag_layout_brackets(Layout *l, char open, const Docs *items, Doc *close, int indent,
                         bool padded, bool hugs);
Doc *cag_layout_filled(Layout *l, char open, const Docs *items, Doc *close, int indent,
                       bool padded);
// `items`: brackets of the same shape, optionally after comments, each with `words` words that
// contain no possible break.
Doc *cag_layout_table(Layout *l, char open, const Docs *items, Doc *close, int indent,
                      size_t words);

// Prints a document, ends its line, and frees all documents.
void cag_layout_print(Layout *l, Doc *d);
// Returns the whole output, malloc'd and NUL-terminated.
char *cag_layout_finish(Layout *l, size_t *length);
// Releases the layout. Allowed at any time; the output of cag_layout_finish remains valid.
void cag_layout_release(Layout *l);

#endif
