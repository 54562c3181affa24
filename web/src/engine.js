// What the page asks of the engine that runs scripts. engine_server.js implements it with a server, and engine_worker.js with workers of the
// page that run cag as WebAssembly.
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
 * @property {{ name: string, origin: Origin[] }[]} [sources]  what the faces of a set operation come from
 *
 * @typedef {object} Joint  values are in degrees or mm
 * @property {string} name
 * @property {"revolute" | "prismatic"} kind
 * @property {number} low
 * @property {number} high
 * @property {number} home
 * @property {number} value  of the script, which may be outside of the limits
 * @property {"deg" | "mm"} unit
 * @property {Place | null} place  of the number in the script
 *
 * @typedef {object} Robot
 * @property {string} name  unique in the scene
 * @property {string[]} parts  names
 * @property {Joint[]} joints
 * @property {string | null} fixed  why the script has no numbers for the joints
 * @property {number[][]} frames  the base, and the frame after each link: 3 rows of 4
 * @property {number[] | null} tool  null: it was flattened, and cannot be moved
 *
 * @typedef {object} RobotPose
 * @property {number[]} q  degrees and mm
 * @property {number[][]} motions  of the parts, from where the scene has them: 3 rows of 4
 * @property {number[][]} frames
 * @property {number[]} tool
 *
 * @typedef {object} ReachRequest
 * @property {string} robot
 * @property {number[]} target  a frame like that of the tool
 * @property {number[]} q  where the robot is
 * @property {"keep" | "exact" | "free"} orientation  free: only the position matters; keep: arms with fewer than 6 joints may give it up
 *
 * @typedef {{ reached: boolean, distance: number, angle: number }} Reached  mm and degrees, from the target to the tool
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
 * @property {string} mark
 * @property {string} text_path  what is drawn, as SVG paths about the location, for a text of height 1
 * @property {string} mark_path
 * @property {string} paper_path  white, below the mark
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
 * @property {Robot[]} [robots]
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
 * @property {Param[]} [params]  of a run that failed, as far as it read them
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
 * @property {boolean} [untitled]  a new script, which has no file
 * @property {boolean} [keepsEdits]  unsaved texts are kept when the page is left
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
 * @typedef {object} FacesAnswer
 * @property {string} mesh  the id of the mesh that the triangles belong to
 * @property {number[]} operands  the source of each operand
 * @property {number[]} faces  pairs of a count of triangles, and their operand
 *
 * @typedef {object} Motion  what the script does to a shape next
 * @property {"translate" | "rotate" | "revolve" | "transform"} kind
 * @property {Triple} point  of an axis
 * @property {Triple} direction  of an axis, or the vector of a translation
 * @property {number} angle  degrees
 * @property {number[] | null} frame  3 rows of 4: the image of the axes
 *
 * @typedef {object} Ghost  a shape that is not shown itself
 * @property {string | null} part  that was made of it
 * @property {string} type
 * @property {string} mesh
 * @property {number[]} placement
 * @property {boolean} line
 * @property {Motion | null} motion
 * @property {Place} place  of the call that made it
 *
 * @typedef {"curvature" | "deviation" | "isolines" | "net"} SurfaceQuestion
 *
 * @typedef {object} SurfaceAnswer  numbers are base64 of 32-bit floats; see floatsOf
 * @property {string} [reason]  why the part has no such thing
 * @property {string} [mesh]  that the values belong to
 * @property {string} [mean]  at the corners of the triangles, 1/mm
 * @property {string} [gaussian]  1/mm2
 * @property {string} [distance]  of the triangles, mm
 * @property {number} [farthest]
 * @property {string} [points]  of lines, in the scene
 * @property {number[]} [sizes]  the points of each line
 *
 * @typedef {object} SectionCurve
 * @property {string} part
 * @property {boolean} closed
 * @property {boolean} exact
 * @property {number} length
 * @property {number | null} area  negative for the outline of a hole; null for an open curve
 * @property {string} points
 *
 * @typedef {Record<string, Record<string, any>>} ParamSets
 *
 * @typedef {object} NumberFields
 * @property {number} value  mm
 * @property {string} unit  as written; "": none
 * @property {number} scale  mm per unit
 * @typedef {Place & NumberFields} PointNumber
 *
 * @typedef {object} PointInfo  a point in a call that made or moved a part
 * @property {number} id  stays the same while only numbers change
 * @property {string} call  the function, such as "polyline"
 * @property {number} dimension  2 or 3 coordinates
 * @property {Triple} at  in the scene
 * @property {{ origin: Triple, normal: Triple } | null} plane  of a point with 2 coordinates
 * @property {number[]} map  3 rows of 4, from the coordinates in the script, mm, to the scene
 * @property {(PointNumber | null)[]} numbers  of each coordinate; null: it is computed
 * @property {boolean[]} moved  by params, of each coordinate
 * @property {string | null} locked  why the point cannot be moved
 * @property {string[]} params  that move it
 *
 * @typedef {object} SolveRequest
 * @property {string} part
 * @property {number} point  its id
 * @property {number[]} target
 * @property {number[][]} ignored  at most two directions in which differences do not count
 * @property {string[]} params
 * @property {number} pixel  its size, mm
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
 * @property {(robot: string, q: number[]) => Promise<RobotPose>} pose  where the parts of a robot are at other joint values
 * @property {(request: ReachRequest) => Promise<RobotPose & Reached>} reach  joint values that bring the tool to a target
 * @property {(messages: object[], check: boolean) => Promise<import("./language.js").Message[]>} lsp  messages of the language server (JSON-RPC); check:
 *   look for problems in what changed. Resolves with what the server has to say
 * @property {(part: string) => Promise<FacesAnswer>} faces
 * @property {(file: string, line: number, column: number) => Promise<Ghost[]>} ghosts  at a location of the script as it was run
 * @property {(part: string, what: SurfaceQuestion) => Promise<SurfaceAnswer>} surface
 * @property {(normal: Triple, offset: number) => Promise<SectionCurve[]>} section
 * @property {(part: string) => Promise<{ points: PointInfo[], omitted: number }>} points
 * @property {(request: SolveRequest) => Promise<{ params: Record<string, string>, at: Triple }>} solve
 *   values of params with which a point comes closest to a target
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

/** The numbers of an answer. @param {string} text  base64 */
export function floatsOf(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

/** An error that the engine reports. */
export class EngineError extends Error {
  /** @param {string} message @param {string} [help] */
  constructor(message, help = "") {
    super(help ? `${message}; ${help}` : message);
  }
}
