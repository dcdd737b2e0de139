// What the programs of a plant say together (tools/input/plant_objects.hpp), for the lines of the programs: an object that nobody
// receives or sends, or one in two forms. Plants are looked at when a file is opened, saved or changed from outside; while a text is
// being typed what was found stands at its line, as long as that line is there.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tools/lsp/workspace.hpp"

namespace ipos::tools::lsp {

class PlantObjects {
 public:
  void outdate() { outdated_ = true; }
  // Of the plants that are open or that have an open program, by path.
  std::map<std::string, Json> diagnostics(Workspace& workspace);

 private:
  struct Found {
    std::string path;  // of the program; of the plant where the program has no lines
    uint32_t line = 0, column = 0;
    std::string row;   // the text of the line then
    std::string text, code, plant;
    auto key() const { return std::tie(path, line, column, text); }
  };
  void look(Workspace& workspace);
  void look_at(Workspace& workspace, const std::string& plant);

  bool outdated_ = true;
  std::vector<Found> found_;
};

}  // namespace ipos::tools::lsp
