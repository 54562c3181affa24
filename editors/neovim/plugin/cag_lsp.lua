-- Starts `cag lsp` for scripts of the cag language. Neovim 0.7 and later.
--
-- Settings, before this file is read:
--   vim.g.cag_command = { "cag", "lsp", "-I", "parts" }
--   vim.g.cag_options = { inlayHints = true, runOnSave = false }

if vim.filetype and vim.filetype.add then vim.filetype.add({ extension = { cag = "cag" } }) end

local clients = {} -- for Neovim 0.7: one server for each root folder

local function root_of(buffer)
  local folder = vim.fn.fnamemodify(vim.api.nvim_buf_get_name(buffer), ":p:h")
  local git = vim.fn.finddir(".git", vim.fn.fnameescape(folder) .. ";")
  return git ~= "" and vim.fn.fnamemodify(git, ":p:h:h") or folder
end

local function start(buffer)
  local root = root_of(buffer)
  local options = vim.g.cag_options or {}
  local config = {
    name = "cag",
    cmd = vim.g.cag_command or { "cag", "lsp" },
    root_dir = root,
    init_options = next(options) and options or nil,
    on_attach = function(_, attached)
      vim.api.nvim_buf_set_option(attached, "omnifunc", "v:lua.vim.lsp.omnifunc")
      vim.api.nvim_buf_set_option(attached, "tagfunc", "v:lua.vim.lsp.tagfunc")
      vim.api.nvim_buf_set_option(attached, "formatexpr", "v:lua.vim.lsp.formatexpr()")
    end,
  }
  if vim.lsp.start then -- Neovim 0.8 and later
    vim.lsp.start(config, { bufnr = buffer })
    return
  end
  config.on_exit = function() clients[root] = nil end
  clients[root] = clients[root] or vim.lsp.start_client(config)
  if clients[root] then vim.lsp.buf_attach_client(buffer, clients[root]) end
end

vim.api.nvim_create_autocmd("FileType", {
  group = vim.api.nvim_create_augroup("cag_lsp", {}),
  pattern = "cag",
  callback = function(event) start(event.buf) end,
})
