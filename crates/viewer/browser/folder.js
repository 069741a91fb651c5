// A plain web server for the folder of the page that computes by itself, under a sub-path as hosts have it: no headers but the type.

import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

export const folder = process.env.WEB ?? "../../../target/page";

const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml", ".wasm": "application/wasm" };
const PREFIX = "/somewhere/below/";

export async function serveFolder() {
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, "http://localhost").pathname;
    const name = path === PREFIX ? "index.html" : normalize(path.slice(PREFIX.length));
    try {
      if (!path.startsWith(PREFIX) || name.startsWith("..")) throw new Error("elsewhere");
      const bytes = await readFile(join(folder, name));
      response.writeHead(200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" });
      response.end(bytes);
    } catch {
      response.writeHead(404);
      response.end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const end = () => new Promise((resolve) => server.close(resolve));
  return { address: `http://127.0.0.1:${server.address().port}${PREFIX}`, end };
}
