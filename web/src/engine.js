// What the page asks of the engine that runs scripts. engine_server.js implements it with a server.
//
// Lengths are in millimeters, Z is up, colors are linear light. Lines and columns count from 1, columns in Unicode code points.

/**
 * @typedef {[number, number, number]} Triple
 *
 * @typedef {object} Place  a range of a script
 * @property {string} file  relative to the folder
 * @property {number} line
 * @property {number} column
 * @property {number} endLine
 * @property {number} endColumn
 *
 * @typedef {object} OriginFields
 * @property {string} what  "show", "changed" (moved or given attributes), or "made"
 * @property {boolean} [library]  in the standard library
 * @typedef {Place & OriginFields} Origin
 *
 * @typedef {object} Param
 * @property {string} name
 * @property {string | null} [description]
 * @property {"number" | "angle" | "choice" | "bool" | "color" | "text" | "other"} kind
 * @property {string} value  an expression of the language
 * @property {string} initial
 * @property {number | null} [low]  mm or degrees
 * @property {number | null} [high]
 * @property {string} [unit]  "deg" of angles
 * @property {string[]} [choices]  expressions
 * @property {Place} [place]
 *
 * @typedef {object} Material
 * @property {string} name
 * @property {Triple} color
 * @property {number} metallic
 * @property {number} roughness
 * @property {number} transmission
 * @property {number} ior
 * @property {Triple} emission
 * @property {number} coat
 * @property {string} texture
 * @property {Triple} color2
 * @property {number} scale
 *
 * @typedef {object} Part
 * @property {string} name
 * @property {string} type
 * @property {string} story
 * @property {string} mesh  the id of a mesh
 * @property {number[] | null} placement  3 rows of 4
 * @property {number} material
 * @property {[number, number][]} labels  pairs of a label and its material
 * @property {boolean} line
 * @property {number} radius
 * @property {[Triple, Triple]} bounds
 * @property {Origin[]} origin
 *
 * @typedef {{ name: string, z: number, size: number | null, material: number }} Ground
 *
 * @typedef {object} SceneCamera
 * @property {string} name
 * @property {Triple} eye
 * @property {Triple} target
 * @property {Triple} up
 * @property {number | null} fov  degrees, horizontal
 * @property {number | null} width  mm, of a camera without perspective
 * @property {[number, number]} size  pixels
 * @property {boolean} automatic
 *
 * @typedef {object} Light
 * @property {"area" | "sun" | "point" | "spot"} kind
 * @property {Triple} position
 * @property {Triple} direction
 * @property {number} angle  degrees, the full cone
 * @property {number} size
 * @property {Triple} color
 * @property {number} strength  1: a white matte face perpendicular to it looks white
 *
 * @typedef {object} SceneLabel
 * @property {string} text
 * @property {Triple} at
 * @property {Triple | null} along  null or zero: none
 * @property {string} place
 * @property {string} mark
 * @property {number} size  mm; 0: of the page
 * @property {number} material
 *
 * @typedef {{ name: string, width?: number, height?: number }} SceneImage
 *
 * @typedef {object} SceneMessage
 * @property {number} run
 * @property {string} script
 * @property {boolean} timed
 * @property {Param[]} params
 * @property {Material[]} materials
 * @property {Part[]} parts
 * @property {Ground[]} grounds
 * @property {SceneCamera[]} cameras
 * @property {Light[]} lights
 * @property {boolean} studio  the lights were added
 * @property {Triple[]} sky  colors from below to above
 * @property {Triple | null} background
 * @property {SceneLabel[]} labels
 * @property {SceneImage[]} images
 * @property {[Triple, Triple]} bounds
 * @property {boolean} drawing  all parts are plane, in one plane of constant z
 * @property {string[]} [files]  that the run read, below the folder
 *
 * @typedef {object} DiagnosticFields
 * @property {"error" | "warning"} severity
 * @property {string} code
 * @property {string} message
 * @property {string | null} help
 * @property {(Place & { message: string })[]} related
 * @typedef {Place & DiagnosticFields} Diagnostic
 *
 * @typedef {object} RunMessages
 * @property {number} run
 * @property {boolean} ok
 * @property {number} seconds
 * @property {number} [memory]  bytes
 * @property {string[]} prints
 * @property {(Place & { name: string, text: string })[]} values  of definitions at the top level
 * @property {Diagnostic[]} diagnostics
 *
 * @typedef {{ run: number, running: boolean }} RunState
 * @typedef {{ path: string, version: string }} FileVersion
 *
 * @typedef {object} Progress
 * @property {number} job
 * @property {number} percent
 * @property {string} phase
 * @property {boolean} done
 * @property {string | null} error
 *
 * @typedef {object} Hello
 * @property {string} version
 * @property {string} file  relative to the folder; "" for a new script
 * @property {string} folder
 * @property {boolean} readOnly
 * @property {boolean} [untitled]  a new script, which cannot be saved
 * @property {[string, string][]} formats  names and descriptions
 * @property {boolean} povray
 *
 * @typedef {object} RunRequest
 * @property {Record<string, string> | null} files  unsaved texts by path
 * @property {Record<string, string>} params
 * @property {number | null} time
 * @property {number | null} frames
 * @property {boolean} loop
 * @property {boolean} coarse
 *
 * @typedef {object} RenderRequest
 * @property {"preview" | "povray"} engine
 * @property {string} quality
 * @property {number} width
 * @property {number} height
 * @property {string | { eye: number[], target: number[], up: number[], fov?: number, width?: number }} camera
 *
 * @typedef {object} Measures  of the true shape; null where the shape has none
 * @property {number | null} area
 * @property {number | null} volume
 * @property {number | null} length
 * @property {Triple | null} centroid
 * @property {[Triple, Triple] | null} bounds
 * @property {boolean | null} watertight
 *
 * @typedef {Record<string, Record<string, any>>} ParamSets
 *
 * @typedef {object} EngineListener
 * @property {(state: RunState) => void} state
 * @property {(scene: SceneMessage) => void} scene
 * @property {(messages: RunMessages) => void} messages
 * @property {(file: FileVersion) => void} file  changed on the disk by somebody else
 * @property {(progress: Progress) => void} progress
 * @property {(connected: boolean, problem: string, restart?: () => void) => void} connection  restart: starts the engine again, if the page can
 *
 * @typedef {object} Engine
 * @property {() => Promise<Hello>} hello
 * @property {(listener: EngineListener) => void} listen  the last state, scene, and messages are sent first
 * @property {(request: RunRequest) => Promise<number>} run  resolves with the number of the run once it is accepted
 * @property {(id: string) => Promise<ArrayBuffer>} mesh
 * @property {() => Promise<FileVersion[]>} files
 * @property {(path: string) => Promise<{ text: string, version: string }>} read  a file, or a module of the library ("std.robots")
 * @property {(path: string, text: string, version: string) => Promise<{ saved: boolean, version: string }>} write
 *   saves unless the file has another version by now, which is then returned
 * @property {(request: RenderRequest) => Promise<number>} render  resolves with the number of the job
 * @property {(job: number) => Promise<Blob>} picture
 * @property {(job: number) => Promise<void>} cancel
 * @property {(format: string) => Promise<{ name: string, blob: Blob }>} export
 * @property {(name: string) => Promise<Blob>} image
 * @property {() => Promise<ParamSets>} sets
 * @property {(sets: ParamSets) => Promise<void>} writeSets
 * @property {(part: string) => Promise<Measures>} measure
 * @property {(messages: object[], check: boolean) => Promise<import("./language.js").Message[]>} lsp  messages of the language server (JSON-RPC); check:
 *   look for problems in what changed. Resolves with what the server has to say
 */

/**
 * Listens at once, and keeps what the engine tells until the page is ready for it.
 *
 * @param {Engine} engine
 * @returns {(listener: EngineListener) => void}  to be called once
 */
export function listenEarly(engine) {
  /** @type {((listener: EngineListener) => void)[]} */
  let kept = [];
  /** @type {EngineListener | null} */
  let ready = null;
  const pass = (/** @type {(listener: EngineListener) => void} */ tell) => (ready ? tell(ready) : kept.push(tell));
  engine.listen({
    state: (x) => pass((l) => l.state(x)),
    scene: (x) => pass((l) => l.scene(x)),
    messages: (x) => pass((l) => l.messages(x)),
    file: (x) => pass((l) => l.file(x)),
    progress: (x) => pass((l) => l.progress(x)),
    connection: (on, problem, restart) => pass((l) => l.connection(on, problem, restart)),
  });
  return (listener) => {
    ready = listener;
    for (const tell of kept) tell(listener);
    kept = [];
  };
}

/** An error that the engine reports. */
export class EngineError extends Error {
  /** @param {string} message @param {string} [help] */
  constructor(message, help = "") {
    super(help ? `${message}; ${help}` : message);
  }
}
