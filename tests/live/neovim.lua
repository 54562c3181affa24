-- Neovim as a client of `cag lsp`: run by tests/live/run.sh as `nvim --headless -u NONE -i NONE -n -S tests/live/neovim.lua`, in a folder with
-- the files of this test. Writes `ok NAME` or `FAILED NAME: WHY` for each test.

local out = assert(io.open(vim.env.OUT, "w"))

local function check(name, good, why)
  out:write(good and ("ok " .. name .. "\n") or ("FAILED " .. name .. ": " .. vim.inspect(why) .. "\n"))
  out:flush()
end

local function wait(condition) return vim.wait(20000, condition, 20) end

local function ask(method, params)
  local answers = vim.lsp.buf_request_sync(0, method, params, 20000)
  for _, answer in pairs(answers or {}) do
    if answer.error then return nil, answer.error end
    return answer.result
  end
end

local function at(mark, inside)
  for i, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    local column = line:find(mark, 1, true)
    if column then
      vim.api.nvim_win_set_cursor(0, { i, column - 1 + (inside or 0) })
      return vim.lsp.util.make_position_params(0, "utf-16")
    end
  end
  error("no " .. mark)
end

local whole = function() return { textDocument = vim.lsp.util.make_text_document_params() } end
local function range()
  local params = vim.lsp.util.make_given_range_params({ 1, 0 }, { vim.fn.line("$"), 0 }, 0, "utf-16")
  params.context = { diagnostics = {} }
  params.options = { tabSize = 2, insertSpaces = true }
  return params
end

local function main()
  vim.opt.runtimepath:append(vim.env.EDITORS .. "/neovim")
  vim.opt.runtimepath:append(vim.env.EDITORS .. "/vim")
  vim.g.cag_command = { vim.env.CAG, "lsp" }
  vim.g.cag_options = { inlayHints = true }
  vim.cmd("filetype plugin on")
  vim.cmd("runtime plugin/cag_lsp.lua")
  vim.cmd("edit a.cag")
  check("the file type is cag", vim.bo.filetype == "cag", vim.bo.filetype)
  local active = vim.lsp.get_clients or vim.lsp.get_active_clients
  check("the server is attached", wait(function()
    local client = active({ bufnr = 0 })[1]
    return client and client.initialized ~= false and client.server_capabilities ~= nil
  end), active({ bufnr = 0 }))
  check("diagnostics arrive", wait(function() return #vim.diagnostic.get(0) == 1 end), vim.diagnostic.get(0))
  local first = vim.diagnostic.get(0)[1] or {}
  check("a diagnostic has its place", first.lnum == 3 and first.col == 6 and first.code == "E0201", first)

  -- The fix of the error is applied by the editor.
  local params = at("raduis")
  local actions = ask("textDocument/codeAction", { textDocument = params.textDocument, range = { start = params.position, ["end"] = params.position }, context = { diagnostics = {} } })
  local fix
  for _, action in ipairs(actions or {}) do if action.title == "Change to `radius`" then fix = action end end
  check("code action", fix, actions)
  if fix then vim.lsp.util.apply_workspace_edit(fix.edit, "utf-16") end
  check("the fix is applied", vim.fn.getline(4) == "print radius, mat.brass.color, b.x, ring(2, 1)", vim.fn.getline(4))
  check("the diagnostics are gone", wait(function() return #vim.diagnostic.get(0) == 0 end), vim.diagnostic.get(0))

  local hover = ask("textDocument/hover", at("ring(2"))
  check("hover", hover and hover.contents.value:find("ring(outer, inner)", 1, true), hover)
  local items = ask("textDocument/completion", at("mat.brass", 4))
  check("completion", items and #items.items > 10, items)
  local signature = ask("textDocument/signatureHelp", at("2, 1)", 3))
  check("signature help", signature and signature.activeParameter == 1, signature)
  local definition = ask("textDocument/definition", at("brass"))
  check("definition", definition and definition[1].uri:find("materials.cag$"), definition)
  params = at("radius =")
  params.context = { includeDeclaration = true }
  local references = ask("textDocument/references", params)
  check("references", references and #references == 2, references)
  check("highlights", #(ask("textDocument/documentHighlight", at("radius =")) or {}) == 2)
  check("document symbols", #(ask("textDocument/documentSymbol", whole()) or {}) == 2)
  check("workspace symbols", #(ask("workspace/symbol", { query = "ring" }) or {}) == 1)
  check("folding", ask("textDocument/foldingRange", whole()))
  params = whole()
  params.positions = { at("radius =").position }
  check("selection ranges", #(ask("textDocument/selectionRange", params) or {}) == 1)
  check("semantic tokens", #((ask("textDocument/semanticTokens/full", whole()) or {}).data or {}) > 50)
  check("document links", #(ask("textDocument/documentLink", whole()) or {}) == 2)
  check("colors", #(ask("textDocument/documentColor", whole()) or {}) == 0)
  check("inlay hints", #(ask("textDocument/inlayHint", range()) or {}) == 2)
  check("code lens", #(ask("textDocument/codeLens", whole()) or {}) == 2)
  check("range formatting", ask("textDocument/rangeFormatting", range()))

  -- Rename in all files, by the editor's own function.
  vim.cmd("edit b.cag")
  check("the other file is attached", wait(function() return #active({ bufnr = 0 }) == 1 end))
  at("x = 2")
  vim.lsp.buf.rename("width")
  check("rename", wait(function() return vim.fn.getline(1) == "width = 2" end), vim.fn.getline(1))
  vim.cmd("buffer a.cag")
  check("rename in the other file", wait(function() return vim.fn.getline(4):find("b.width", 1, true) end), vim.fn.getline(4))

  -- Formatting, and text that is not ASCII.
  vim.fn.setline(3, "ring(outer,inner)=outer+inner // θ😀")
  check("changes arrive", wait(function() return #vim.diagnostic.get(0) == 0 end))
  if vim.lsp.buf.format then vim.lsp.buf.format() else vim.lsp.buf.formatting_sync(nil, 20000) end
  check("formatting", vim.fn.getline(3) == "ring(outer, inner) = outer + inner  // θ😀", vim.fn.getline(3))
  check("omni completion is set", vim.bo.omnifunc == "v:lua.vim.lsp.omnifunc", vim.bo.omnifunc)
  for _, client in ipairs(active()) do vim.lsp.stop_client(client.id or client) end
  check("the server ends", wait(function() return #active() == 0 end))
end

local good, why = xpcall(main, debug.traceback)
if not good then check("the test", false, why) end
out:close()
vim.cmd("qall!")
