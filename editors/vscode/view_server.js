// A process of `cag view`: its start, requests to it, and its stream of events.

const { spawn } = require("child_process");
const http = require("http");
const zlib = require("zlib");

const START_LIMIT = 20000; // milliseconds until the address is printed
const IDLE = 15000; // milliseconds that a connection is kept; the server keeps it for longer
const LONGEST_ERROR = 4000; // characters of the program's messages

// The processes end with the editor.
const children = new Set();
process.on("exit", () => children.forEach((child) => child.kill()));

// Splits a stream of server-sent events: event(name, data) is called for each.
class EventReader {
  constructor(event) {
    this.event = event;
    this.parts = []; // of the event that has not ended
  }

  read(chunk) {
    let from = 0;
    const last = this.parts[this.parts.length - 1];
    // The empty line that ends an event can be divided between two chunks.
    if (last && last.endsWith("\n") && chunk.startsWith("\n")) from = this.end(chunk, 0, 1);
    for (let at; (at = chunk.indexOf("\n\n", from)) >= 0;) from = this.end(chunk, from, at + 2);
    if (from < chunk.length) this.parts.push(chunk.slice(from));
  }

  end(chunk, from, to) {
    const text = this.parts.join("") + chunk.slice(from, to);
    this.parts = [];
    let name = "message", data = "";
    for (const line of text.split("\n")) {
      if (line.startsWith("event: ")) name = line.slice(7);
      else if (line.startsWith("data: ")) data += line.slice(6);
    }
    if (data) this.event(name, data);
    return to;
  }
}

class ViewServer {
  // ended(reason): called when the process ends by itself.
  constructor(command, args, ended) {
    this.command = command;
    this.args = args;
    this.ended = ended;
    this.running = false;
    this.errors = ""; // what the program wrote on its standard error
    this.agent = new http.Agent({ keepAlive: true, maxSockets: 8, timeout: IDLE });
  }

  // Resolves when the server answers. The error says why it does not.
  async start() {
    const address = new URL(await this.launch());
    this.port = Number(address.port);
    // The first visit sets the cookie that all requests need.
    const { headers } = await this.request(address.pathname + address.search);
    const [cookie] = headers["set-cookie"] || [];
    if (!cookie) throw new Error(`\`${this.command} view\` printed the address ${address.origin}, where no page is`);
    this.cookie = cookie.split(";")[0];
  }

  launch() {
    return new Promise((resolve, reject) => {
      const fail = (text) => {
        this.stop();
        reject(new Error(text));
      };
      const timer = setTimeout(() => fail(`\`${this.command} view\` printed no address within ${START_LIMIT / 1000} s`), START_LIMIT);
      const child = this.process = spawn(this.command, ["view", ...this.args, "--no-open"], { stdio: ["ignore", "pipe", "pipe"] });
      children.add(child);
      let output = "";
      child.stdout.setEncoding("utf8").on("data", (text) => {
        if (this.running) return;
        output += text;
        const found = /^http:\/\/\S+/m.exec(output);
        if (!found || !output.includes("\n", found.index)) return;
        clearTimeout(timer);
        this.running = true;
        resolve(found[0]);
      });
      child.stderr.setEncoding("utf8").on("data", (text) => (this.errors = (this.errors + text).slice(-LONGEST_ERROR)));
      child.on("error", (error) => {
        clearTimeout(timer);
        children.delete(child);
        fail(`cannot start \`${this.command} view\`: ${error.message}. The setting cag.command is the path of the program.`);
      });
      child.on("exit", (status, signal) => {
        children.delete(child);
        if (!this.running) return;
        this.running = false;
        this.agent.destroy();
        if (!this.stopped) this.ended(`\`${this.command} view\` ${signal ? `was ended by the signal ${signal}` : `has ended with status ${status}`}`);
      });
      // What the program says is read to its end first.
      child.on("close", (status) => {
        clearTimeout(timer);
        fail(this.whyNot(status)); // unless it has started
      });
    });
  }

  whyNot(status) {
    const why = this.errors.trim() || `it ended with status ${status}`;
    const old = /command [`'"]view/.test(why) ? " This version of the program has no preview; install a newer one, or set cag.command to its path." : "";
    return `cannot start \`${this.command} view\`: ${why}.${old}`.replace(/\.\.$/, ".");
  }

  open(path, { method = "GET", headers = {}, body = null, agent = this.agent } = {}) {
    return new Promise((resolve, reject) => {
      if (!this.running) {
        reject(new Error("the server of the preview does not run"));
        return;
      }
      const all = { ...headers, ...(this.cookie ? { Cookie: this.cookie } : {}) };
      if (body !== null) all["Content-Length"] = Buffer.byteLength(body);
      const request = http.request({ host: "127.0.0.1", port: this.port, path, method, headers: all, agent }, resolve);
      request.on("error", reject);
      if (body !== null) request.write(body);
      request.end();
    });
  }

  // Resolves with { status, headers, body }, a buffer.
  async request(path, options) {
    const response = await this.open(path, options), parts = [];
    for await (const part of response) parts.push(part);
    const bytes = Buffer.concat(parts), zipped = response.headers["content-encoding"] === "gzip";
    return { status: response.statusCode, headers: response.headers, body: zipped ? zlib.gunzipSync(bytes) : bytes };
  }

  // Listens to the events of the server until the returned function is called.
  listen({ opened, event, closed }) {
    let response = null, over = false;
    const end = () => {
      if (!over) closed();
      over = true;
    };
    this.open("/api/events", { agent: false }).then((found) => {
      response = found;
      if (over || found.statusCode !== 200) {
        found.destroy();
        return end();
      }
      opened();
      const reader = new EventReader((name, data) => over || event(name, data));
      response.setEncoding("utf8").on("data", (chunk) => reader.read(chunk)).on("end", end).on("error", end);
    }, end);
    return () => {
      over = true;
      if (response) response.destroy();
    };
  }

  stop() {
    this.stopped = true;
    if (this.process) this.process.kill();
  }
}

module.exports = { ViewServer, EventReader };
