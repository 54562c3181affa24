// The secret in the address of a server, which its page needs for all requests.

#ifndef CAG_LIVE_SERVER_TOKEN_H
#define CAG_LIVE_SERVER_TOKEN_H

#include <stdbool.h>

enum { CAG_SERVER_TOKEN = 32 };

// Makes the token of a server, CAG_SERVER_TOKEN characters. A server on a port that the user chose
// (else 0) has the token of the one before it there, which is kept in a file that only the user can
// read: pages that were open then connect to it without a new address. Returns false if the system
// has no random numbers.
bool cag_server_make_token(int port, char out[CAG_SERVER_TOKEN + 1]);

#endif
