// Plants and tests (TOML) in the editor. What is right is asked of the readers of `ipos run` and `ipos test`
// themselves: their messages are the diagnostics, and what they say is known is what completion offers.
#pragma once

#include "tools/lsp/workspace.hpp"

namespace ipos::tools::lsp {

// A test by its name; another TOML file if it has the sections of a plant.
bool is_plant_document(const Workspace& workspace, const std::string& path);

Json plant_diagnostics(const Workspace& workspace, const std::string& path);
Json plant_hover(Workspace& workspace, const Json& params);
Json plant_completion(Workspace& workspace, const Json& params);
// From a program or plant that is named to the file, from a variable to its declaration.
Json plant_definition(Workspace& workspace, const Json& params);
// The tables of the file.
Json plant_symbols(Workspace& workspace, const Json& params);

}  // namespace ipos::tools::lsp
