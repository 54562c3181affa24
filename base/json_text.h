// Texts in JSON.

#ifndef CAG_BASE_JSON_TEXT_H
#define CAG_BASE_JSON_TEXT_H

// The escape of a byte in a JSON string, written to the buffer, or NULL if the byte stands for
// itself. Control characters below U+0020, quotation marks, and backslashes have one.
const char *cag_json_escape(char byte, char buffer[8]);

#endif
