// What the page asks about the last scene. All engines answer in the same way (live/questions.c).

/**
 * @param {(question: string, request: object) => Promise<any>} ask
 * @returns {Pick<import("./engine.js").Engine, "points" | "solve" | "pose" | "reach" | "faces" | "ghosts" | "surface" | "section">}
 */
export const questions = (ask) => ({
  points: (part) => ask("points", { part }),
  solve: (request) => ask("solve", request),
  pose: (robot, q) => ask("pose", { robot, q }),
  reach: (request) => ask("reach", request),
  faces: (part) => ask("faces", { part }),
  ghosts: async (file, line, column) => (await ask("ghost", { file, line, column })).ghosts,
  surface: (part, what) => ask("surface", { part, what }),
  section: async (normal, offset) => (await ask("section", { normal, offset })).curves,
});
