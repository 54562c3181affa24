// Converts Markdown (CommonMark) on standard input to the text of a man page with libcmark-gfm.
// tools/man.sh adds the title and adapts the result to mandoc.

#include <cmark-gfm.h>
#include <stdio.h>
#include <stdlib.h>

int main(void) {
  cmark_node *document = cmark_parse_file(stdin, CMARK_OPT_DEFAULT);
  char *page = document ? cmark_render_man(document, CMARK_OPT_DEFAULT, 0) : NULL;
  if (!page || ferror(stdin) || fputs(page, stdout) == EOF || fclose(stdout) == EOF) return 1;
  free(page);
  cmark_node_free(document);
  return 0;
}
