// Escapes in JSON texts.

#ifndef CAG_BASE_JSON_TEXT_H
#define CAG_BASE_JSON_TEXT_H

// Returns the escape of a byte in a JSON string, written to the buffer, or NULL if the byte needs
// none. Control characters below U+0020, quotation marks, and backslashes need one.
const char *cag_json_escape(char byte, char buffer[8]);

#endif
