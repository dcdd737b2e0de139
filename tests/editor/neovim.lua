-- What neovim.sh asks for in the editor; the first difference ends it with exit code 1.
local function fail(text)
  io.stdout:write(text .. '\n')
  vim.cmd('cquit 1')
end

local answered = 0
local function check(what, good, seen)
  if not good then fail(what .. ': ' .. vim.inspect(seen)) end
  answered = answered + 1
end

local function wait(what, holds)
  if not vim.wait(20000, holds, 20) then fail(what .. ' does not come') end
end

local function ask(method, params)
  local results, mistake = vim.lsp.buf_request_sync(0, method, params, 20000)
  if mistake or not results or not next(results) then fail(method .. ': ' .. vim.inspect(mistake)) end
  local _, reply = next(results)
  if reply.error then fail(method .. ': ' .. vim.inspect(reply.error)) end
  return reply.result
end

local function at(line, column)
  vim.api.nvim_win_set_cursor(0, { line, column })
  return vim.lsp.util.make_position_params()
end

wait('the language server', function()
  for _, client in pairs(vim.lsp.buf_get_clients(0)) do
    if client.initialized then return true end
  end
  return false
end)

wait('the message', function() return #vim.diagnostic.get(0) > 0 end)
local message = vim.diagnostic.get(0)[1]
check('message', message.lnum == 5 and message.message:find('lTooth'), message)

local hover = ask('textDocument/hover', at(5, 5))
check('hover', vim.inspect(hover.contents):find('of the saw'), hover)

local place = ask('textDocument/definition', at(5, 5))
place = vim.tbl_islist(place) and place[1] or place
check('definition', place.range.start.line == 1, place)

-- The mistake is mended in the editor, and the message goes.
vim.api.nvim_buf_set_lines(0, 5, 6, true, { '    lTeeth = 2;' })
wait('the end of the message', function() return #vim.diagnostic.get(0) == 0 end)
answered = answered + 1

local rename = at(2, 5)
rename.newName = 'lBlades'
local client = next(vim.lsp.buf_get_clients(0))
vim.lsp.util.apply_workspace_edit(ask('textDocument/rename', rename), vim.lsp.get_client_by_id(client).offset_encoding)
local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), '\n')
check('rename', text:find('lBlades = lBlades %+ 1;') and not text:find('lTeeth'), text)

vim.api.nvim_buf_set_lines(0, 4, 5, true, { 'lBlades=lBlades+1;' })
vim.lsp.util.apply_text_edits(
  ask('textDocument/formatting', { textDocument = vim.lsp.util.make_text_document_params(),
                                   options = { tabSize = 4, insertSpaces = true } }),
  vim.api.nvim_get_current_buf(), vim.lsp.get_client_by_id(client).offset_encoding)
local line = vim.api.nvim_buf_get_lines(0, 4, 5, true)[1]
check('formatting', line == '    lBlades = lBlades + 1;', line)

io.stdout:write(answered .. ' requests, all answered\n')
vim.cmd('qall!')
