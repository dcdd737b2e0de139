// The answers of the server, a function a request. Each takes the params of its request as the protocol has
// them and gives its result; null where there is nothing to say.
#pragma once

#include "stdlib/parameters.hpp"
#include "tools/lsp/workspace.hpp"
#include "tools/survivors/survivors.hpp"

namespace ipos::tools::lsp {

// A position of the editor in the program it is looked at in.
struct Cursor {
  const Program& program;
  const compiler::SourceFile* file;  // nullptr: the program does not read this file
  uint32_t offset = 0;
  const compiler::Occurrence* occurrence = nullptr;
  const compiler::IndexedSymbol* symbol = nullptr;
};
std::string document_path(const Json& params);
Cursor cursor_of(Workspace& workspace, const Json& params);
// Letters, digits and _ around the cursor, with their place.
compiler::Place word_at(const Cursor& cursor);

Json location(const Workspace& workspace, const compiler::Place& place);

Json hover(Workspace& workspace, const Json& params);
Json completion(Workspace& workspace, const Json& params);
Json signature_help(Workspace& workspace, const Json& params);
Json definition(Workspace& workspace, const Json& params);
Json references(Workspace& workspace, const Json& params);
Json program_references(Workspace& workspace, const Json& params);  // in sources and headers alone
Json highlights(Workspace& workspace, const Json& params);
Json prepare_rename(Workspace& workspace, const Json& params);
Json rename(Workspace& workspace, const Json& params);
Json document_symbols(Workspace& workspace, const Json& params);
Json workspace_symbols(Workspace& workspace, const Json& params);
Json formatting(Workspace& workspace, const Json& params);
Json header_text(Workspace& workspace, const Json& params);

// The messages of a program by the path of the file they are about.
std::map<std::string, Json> diagnostics_of(const Workspace& workspace, const Program& program);

// The mistakes that no test has noticed, as messages of a source.
Json diagnostics_of(const Workspace& workspace, const std::string& path, const std::vector<Survivor>& survivors);

// In the words of a hover; the place in a program gives the number of a variable.
std::string describe(const Program& program, const compiler::IndexedSymbol& symbol,
                     std::optional<uint32_t> number);
std::string describe_system_function(std::string_view name);
std::string describe_parameter(const stdlib::Parameter& parameter);
// The comment after a declaration, else those above it.
std::string comment_of(const compiler::IndexedSymbol& symbol);

}  // namespace ipos::tools::lsp
