// The page of cag view: its engine is the server.

import { serverEngine } from "./engine_server.js";
import { showFailure, start } from "./page.js";
import { findWebview } from "./webview.js";

const webview = findWebview();
start(serverEngine(webview?.transport), webview).catch(showFailure);
