-- What a user of Neovim does with `bigactors lsp` by Neovim's own client; what comes of it goes to a file, as JSON.
-- Arguments: the command line of the server, the mission, and the file for the results.
local server, mission, results = unpack(vim.split(vim.env.BIGACTORS_EDITED, "\n"))
local found = {}

local function wait(what, ready)
  if not vim.wait(30000, ready, 20) then
    error("nothing came of " .. what)
  end
end

local function place(words, inside)
  for row, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, true)) do
    local column = line:find(words, 1, true)
    if column then
      vim.api.nvim_win_set_cursor(0, { row, column - 1 + (inside or 0) })
      return
    end
  end
  error("the text has no " .. words)
end

local function ask(method, more)
  local params = vim.tbl_extend("force", vim.lsp.util.make_position_params(), more or {})
  local answers = vim.lsp.buf_request_sync(0, method, params, 30000)
  if not answers then
    error("nothing came of " .. method)
  end
  local _, answer = next(answers)
  return answer.result
end

local function play()
  vim.cmd("edit " .. vim.fn.fnameescape(mission))
  local client = vim.lsp.start_client({ name = "bigactors", cmd = { server, "lsp" }, root_dir = vim.fn.getcwd() })
  vim.lsp.buf_attach_client(0, client)
  wait("the mistakes", function() return #vim.diagnostic.get(0) > 0 end)
  found.mistakes = vim.tbl_map(function(each)
    return { each.lnum + 1, each.col + 1, each.message }
  end, vim.diagnostic.get(0))

  place("serchArea0")
  local action = ask("textDocument/codeAction", {
    range = vim.lsp.util.make_range_params().range,
    context = { diagnostics = vim.lsp.diagnostic.get_line_diagnostics() },
  })
  place("serchArea0")
  vim.lsp.util.apply_workspace_edit(action[1].edit, "utf-16")
  wait("the mended text", function() return #vim.diagnostic.get(0) == 0 end)

  place("oilSpill0 in obs")
  found.hover = ask("textDocument/hover").contents.value
  vim.lsp.buf.definition()
  wait("the definition", function()
    return vim.api.nvim_get_current_line():find("oilSpill0: OilSpill", 1, true) ~= nil
  end)
  found.definition = vim.api.nvim_win_get_cursor(0)[1]
  vim.lsp.buf.rename("slick")
  wait("the renamed text", function() return vim.fn.search("oilSpill0", "nw") == 0 end)
  found.renamed = vim.fn.searchcount({ pattern = "slick", maxcount = 0 }).total

  place("MOVE_HOST_TO slick", #"MOVE_HOST_TO ")
  found.completion = vim.tbl_map(function(each) return each.label end, ask("textDocument/completion"))
  vim.lsp.buf.formatting_sync(nil, 60000)
  found.text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), "\n") .. "\n"
  found.lenses = #ask("textDocument/codeLens")
end

local ok, message = pcall(play)
found.error = not ok and message or nil
vim.fn.writefile({ vim.fn.json_encode(found) }, results)
vim.cmd("qall!")
