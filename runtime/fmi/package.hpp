// The files in `resources` of an FMU: the plant, its programs as images, what its memories held, and what of it is offered.
// fmu.txt, a line a fact, leads to the others.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/fmi/variables.hpp"
#include "runtime/library/contents.hpp"

namespace ipos::fmi {

struct Package {
  // Of a station, in the order of the plant.
  struct Station {
    std::optional<vm::Image> program;
    std::optional<std::string> memory;  // bytes of its memory file
    std::string memory_file;            // of a folder that was read: where it lies
  };
  std::string plant;  // text of the plant file
  std::vector<Station> stations;
  Choice choice;
  std::string token;  // of the content; empty until files_of() has made it
};

// The files by their names, without the sources. The token is made of them and of `program`, the version that made them.
std::map<std::string, std::string> files_of(Package& package, const std::string& program);

// Of a folder that is there; the error names the file.
tl::expected<Package, std::string> read_package(const std::string& folder);

// The plant of it.
tl::expected<library::Contents, std::string> contents_of(const Package& package);

}  // namespace ipos::fmi
