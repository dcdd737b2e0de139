// What a plant is made of: its file and the programs of its stations, read and compiled once. The same plant can be
// built of it again and again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant/plant.hpp"
#include "runtime/unit/program_shelf.hpp"

namespace ipos::library {

// Line and column count from 1; 0: of the file as a whole.
struct Mistake {
  std::string file;
  uint32_t line = 0;
  uint32_t column = 0;
  std::string text;
};
using Mistakes = std::vector<Mistake>;

struct Source {
  std::string path;                 // of a plant file or a program; may be empty with `text`
  std::optional<std::string> text;  // in place of the file's
  std::optional<std::string> folder;
  std::vector<std::string> include_dirs;
  std::vector<std::string> defines;
  bool write_memory = false;
  // In place of the files that the plant names, a row a station: its image, and where its memory lies; empty: it has none.
  struct Given {
    std::optional<vm::Image> program;
    std::string memory;
  };
  std::optional<std::vector<Given>> given{};
  std::optional<std::string> lone_line{};  // of the plant only this line, without its stations
  uint32_t commands_a_ms = 0;  // 0: as P938 and P939 say
  uint64_t seed = 0;
};

class Contents {
 public:
  // All mistakes at once, as `ipos run` tells them.
  static tl::expected<Contents, Mistakes> read(const Source& source);

  // At time 0, switched on. Mistakes are those that only the units find.
  tl::expected<std::unique_ptr<runtime::Plant>, Mistakes> build() const;

  // Its units keep in files what they store.
  bool writes_memory() const;
  // The same number for the same plant, programs and options.
  uint64_t identity() const { return identity_; }

 private:
  // What is wrong with a program stands in `errors` if it has a place in the plant file, else in `of_programs`.
  void load_programs(const Source& source, std::vector<runtime::PlantError>& errors, Mistakes& of_programs);
  std::optional<vm::Image> load_program(const Source& source, runtime::StationConfig& station,
                                        std::vector<runtime::PlantError>& errors, Mistakes& of_programs);
  void take_given(const std::vector<Source::Given>& given, std::vector<runtime::PlantError>& errors);
  void identify(std::string_view text, const Source& source);

  std::string name_;    // of the plant file in messages
  std::string folder_;  // empty: the current one
  runtime::PlantFile file_;
  std::vector<std::optional<vm::Image>> programs_;
  std::optional<vm::Rates> rates_;
  runtime::Execution execution_{.shelf = std::make_shared<runtime::ProgramShelf>()};
  uint64_t identity_ = 0;
};

}  // namespace ipos::library
