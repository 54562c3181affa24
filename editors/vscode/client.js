// A client of the Language Server Protocol on the standard streams of a program: requests, notifications, and their framing.

const { spawn } = require("child_process");

class Client {
  // handlers: { method: params => result } for what the server sends; ended(code): called when the program ends.
  constructor(command, args, handlers, ended) {
    this.pending = new Map();
    this.handlers = handlers;
    this.next = 1;
    this.buffer = Buffer.alloc(0);
    this.process = spawn(command, args, { stdio: ["pipe", "pipe", "pipe"] });
    this.process.on("error", (error) => this.end(error.message, ended));
    this.process.on("exit", (code) => this.end(`the server has ended with status ${code}`, ended));
    this.process.stdout.on("data", (data) => this.read(data));
    this.process.stderr.on("data", (data) => handlers.log && handlers.log(data.toString()));
    this.process.stdin.on("error", () => {});
  }

  end(reason, ended) {
    if (!this.process) return;
    this.process = null;
    for (const { reject } of this.pending.values()) reject(new Error(reason));
    this.pending.clear();
    if (ended) ended(reason);
  }

  send(message) {
    if (!this.process) return;
    const body = Buffer.from(JSON.stringify({ jsonrpc: "2.0", ...message }));
    this.process.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
    this.process.stdin.write(body);
  }

  notify(method, params) {
    this.send({ method, params });
  }

  // token: a CancellationToken of the editor; may be undefined.
  request(method, params, token) {
    if (!this.process) return Promise.reject(new Error("the server does not run"));
    const id = this.next++;
    const answer = new Promise((resolve, reject) => this.pending.set(id, { resolve, reject }));
    if (token) token.onCancellationRequested(() => this.notify("$/cancelRequest", { id }));
    this.send({ id, method, params });
    return answer;
  }

  read(data) {
    this.buffer = Buffer.concat([this.buffer, data]);
    for (;;) {
      const end = this.buffer.indexOf("\r\n\r\n");
      if (end < 0) return;
      const length = Number(/content-length: *(\d+)/i.exec(this.buffer.toString("latin1", 0, end))[1]);
      if (this.buffer.length < end + 4 + length) return;
      const message = JSON.parse(this.buffer.toString("utf8", end + 4, end + 4 + length));
      this.buffer = this.buffer.subarray(end + 4 + length);
      this.take(message);
    }
  }

  async take(message) {
    if (message.method) {
      const handler = this.handlers[message.method];
      const result = handler ? await handler(message.params) : null;
      if (message.id !== undefined) this.send({ id: message.id, result: result === undefined ? null : result });
      return;
    }
    const waiting = this.pending.get(message.id);
    if (!waiting) return;
    this.pending.delete(message.id);
    if (message.error) waiting.reject(Object.assign(new Error(message.error.message), { code: message.error.code }));
    else waiting.resolve(message.result);
  }
}

module.exports = { Client };
