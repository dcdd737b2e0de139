// Where plants and tests name what others define: variables of programs, and stations. For rename, references and
// the ways between a program and its plants.
#pragma once

#include "tools/lsp/features.hpp"
#include "tools/lsp/workspace.hpp"

namespace ipos::tools::lsp {

// A name in a plant or test, with its place there.
struct NameUse {
  std::string path;
  uint32_t begin = 0, end = 0;
  bool definition = false;  // name = "..." of the station itself
};

struct VariableUse : NameUse {
  std::string text;     // "left.speed[1]"
  std::string program;  // path of the program of its station
};

// Texts that name variables, in the plants and tests of the folders and the editor.
std::vector<VariableUse> variable_uses(Workspace& workspace);
// Those of one file.
std::vector<VariableUse> variable_uses(const Workspace& workspace, const std::string& path);

// The symbols that a text names, member by member, each with its piece of the text.
struct NamedSymbol {
  size_t symbol = 0;  // of the index
  size_t begin = 0, end = 0;
};
std::vector<NamedSymbol> symbols_in(const compiler::ProgramIndex& index, std::string_view text);

// Where plants and tests name the symbol, which may be that of another program with the same header.
std::vector<NameUse> uses_of(Workspace& workspace, const Program& program, const compiler::IndexedSymbol& symbol);

// Stations that execute the program, for the way back: path of the plant, name and place of the station.
struct StationOf : NameUse {
  std::string station;
};
std::vector<StationOf> stations_of(Workspace& workspace, const std::string& program);

// All places of the name of a station: its definition in the plant, and what names it there and in its tests.
std::vector<NameUse> station_uses(Workspace& workspace, const std::string& path, const std::string& station);

Json location_of(const Workspace& workspace, const NameUse& use);

// Of a cursor in a plant or test: the variable or station it stands on.
Json plant_references(Workspace& workspace, const Json& params);
Json plant_prepare_rename(Workspace& workspace, const Json& params);
Json plant_rename(Workspace& workspace, const Json& params);
// The declaration of the variable; null where there is none.
Json plant_variable(Workspace& workspace, const Json& params);

}  // namespace ipos::tools::lsp
