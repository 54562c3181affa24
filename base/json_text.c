#include "base/json_text.h"

#include <stdio.h>

const char *cag_json_escape(char byte, char buffer[8]) {
  const unsigned char c = (unsigned char)byte;
  switch (c) {
  case '"': return "\\\"";
  case '\\': return "\\\\";
  case '\n': return "\\n";
  case '\t': return "\\t";
  default: break;
  }
  if (c >= ' ') return NULL;
  snprintf(buffer, 8, "\\u%04x", (unsigned)c);
  return buffer;
}
