// Where the operands of set operations come from.

#ifndef CAG_INTERP_SESSION_SOURCES_H
#define CAG_INTERP_SESSION_SOURCES_H

#include "interp/session/session.h"

void cag_session_drop_sources(CagSession *s);

#endif
