#include "live/place_json.h"

void cag_live_place(CagJson *j, const CagPlaceView *p) {
  cag_json_text(j, "file", p->file);
  cag_json_number(j, "line", (double)p->line);
  cag_json_number(j, "column", (double)p->column);
  cag_json_number(j, "endLine", (double)p->end_line);
  cag_json_number(j, "endColumn", (double)p->end_column);
  cag_json_bool(j, "library", p->library);
}
