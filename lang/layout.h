// Documents: text that knows where it may be broken into lines, and their printer.
//
// In the manner of Wadler ("A prettier printer", 2003): a document is text, a place for a line
// break, or a combination; the printer sets each group on one line where it fits and breaks it
// otherwise. Each document keeps its width on one line and the width up to its first possible
// break, so no decision looks at more than the neighbors. Comments at the ends of
// neighboring lines are set one below the other. Line breaks are lazy: one is printed
// when the next text comes, so breaks that meet are one, and a comment that stood at the end of a
// line goes there again. Everything made since the last cag_layout_print lives until the next.
// If memory runs out, control returns to the guard (base/guard.h).

#ifndef CAG_LANG_LAYOUT_H
#define CAG_LANG_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/source.h"

typedef enum DocKind {
  DOC_TEXT,
  DOC_LINE,     // text (a space, or nothing) on one line, else a line break
  DOC_HARD,     // always a line break
  DOC_BLANK,    // the next line break leaves a line empty
  DOC_TRAILING, // a comment at the end of the line
  DOC_COMMENT,  // a comment on a line of its own
  DOC_INLINE,   // a comment within the line, a space before it
  DOC_CONCAT,   // breaks as what it stands in
  DOC_NEST,     // breaks as what it stands in, indented
  DOC_GROUP,    // on one line, or all its lines broken
  DOC_STAGES,   // a head and what follows it: on one line; or the head broken, and the rest behind
                // its closing bracket; or as a group
  DOC_FILL,     // each line broken only where the next item does not fit; those behind the first
                // are indented
  DOC_BRACKETS, // items between brackets: on one line, or one to a line
  DOC_FILLED,   // items between brackets: on one line, or filled
  DOC_TABLE     // rows of words between brackets: on one line, or one to a line, their words one
                // below the other
} DocKind;

// Wider than any line: holds a break that must be.
#define DOC_ENDLESS ((uint32_t)1 << 28)

typedef struct Doc Doc;
struct Doc {
  uint8_t kind;   // DocKind
  bool breaks;    // holds a place for a break
  bool comma;     // a comma stands behind it, which both widths count
  bool hugs;      // BRACKETS: the last item may open on the line of the bracket
  bool opens;     // BRACKETS: the first item may open on their line, and the short rest close it
  bool gathers;   // BRACKETS: broken, all items may stand on one line of their own
  bool padded;    // BRACKETS: on one line, with spaces within
  char bracket;   // BRACKETS: the opening one
  uint32_t width; // on one line; DOC_ENDLESS: not possible
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
    uint32_t pad; // a word of a TABLE: columns before it that make it end below the others
  };
  Doc *next; // behind it in the same parent
};

typedef struct Docs {
  Doc *head, *tail;
} Docs;

typedef struct LayoutBlock LayoutBlock;
typedef struct LayoutTrailing {
  size_t at; // end of the code in the output, and beginning of the comment
  size_t line;
  uint32_t column, indent; // of the code
} LayoutTrailing;

typedef struct Layout {
  const CagSource *source; // what is laid out
  uint32_t width;
  LayoutBlock *blocks, *block; // of documents; the one in use
  char *out;
  size_t length, capacity;
  size_t line;
  uint32_t column, indent;
  bool pending, blank; // a line break waits, and leaves a line empty
  bool closed;         // the line ends in a comment
  int pending_indent;
  LayoutTrailing *trailing; // those of neighboring lines that are not aligned yet
  size_t trailing_count, trailing_capacity;
} Layout;

void cag_layout_init(Layout *l, const CagSource *source, uint32_t width);
// Memory that lives as long as the documents.
void *cag_layout_memory(Layout *l, size_t size);

static inline void layout_add(Docs *list, Doc *d) {
  if (list->tail) list->tail->next = d;
  else list->head = d;
  list->tail = d;
}
Doc *cag_layout_text(Layout *l, const char *text, size_t length); // borrowed; may hold line breaks
// A word of ASCII without line breaks, borrowed.
Doc *cag_layout_plain(Layout *l, const char *word, size_t length);
Doc *cag_layout_space(Layout *l); // a LINE that is a space on one line
Doc *cag_layout_hard(Layout *l);
Doc *cag_layout_blank(Layout *l);
Doc *cag_layout_trailing(Layout *l, Doc *text);
Doc *cag_layout_comment(Layout *l, Doc *text);
Doc *cag_layout_inline(Layout *l, Doc *text);
Doc *cag_layout_concat(Layout *l, const Docs *parts);
void cag_layout_comma(Doc *d); // puts a comma behind it
Doc *cag_layout_group(Layout *l, Doc *d);
Doc *cag_layout_stages(Layout *l, Doc *head, Doc *rest);
Doc *cag_layout_nest(Layout *l, int indent, const Docs *parts);
Doc *cag_layout_fill(Layout *l, int indent, const Docs *items); // items and LINEs in turn
// `items`: items and LINEs in turn. `hugs`: where all but the last fit, the last may begin behind
// them, so that its own brackets close with these.
Doc *cag_layout_brackets(Layout *l, char open, const Docs *items, Doc *close, int indent,
                         bool padded, bool hugs);
Doc *cag_layout_filled(Layout *l, char open, const Docs *items, Doc *close, int indent,
                       bool padded);
// `items`: brackets of one shape, perhaps with comments before them, with `words` words each in
// which no line can be broken.
Doc *cag_layout_table(Layout *l, char open, const Docs *items, Doc *close, int indent,
                      size_t words);

// Prints a document and ends its line; forgets all documents.
void cag_layout_print(Layout *l, Doc *d);
// Returns the whole output, malloc'd and NUL-terminated.
char *cag_layout_finish(Layout *l, size_t *length);
// Releases the layout. Allowed at any time; the output of cag_layout_finish remains valid.
void cag_layout_release(Layout *l);

#endif
