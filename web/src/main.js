// The page of cag view: its engine is the server.

import { serverEngine } from "./engine_server.js";
import { showFailure, start } from "./page.js";

start(serverEngine()).catch(showFailure);
