// What of a campaign its results need beside their rows: the factors with their levels, the measures, how cases are chosen, and
// one number over all that decides a result. A folder of results has it as plan-NUMBER.json, so that `ipos campaign merge` needs
// nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/design.hpp"

namespace ipos::tools::campaign {

// One value of a factor.
struct Level {
  std::string text;  // as a table of results shows it
  std::string json;  // the same as JSON
  uint64_t identity = 0;  // of the value, and of what it names
};

struct FactorOutline {
  std::string name;
  std::vector<Level> levels;

  uint32_t middle() const { return static_cast<uint32_t>((levels.size() - 1) / 2); }
};

struct MeasureOutline {
  std::string name;
  std::string unit;
  std::optional<double> at_least;
  std::optional<double> at_most;
};

using Levels = std::vector<uint32_t>;  // the level of each factor

struct Outline {
  std::string campaign;   // name of its file
  std::string version;    // of ipos
  uint64_t identity = 0;  // of all that decides a result but the levels
  std::map<std::string, uint64_t> inputs;  // of each file that was read
  Sampling sampling;
  std::vector<FactorOutline> factors;
  std::vector<MeasureOutline> measures;

  uint64_t case_of(const Levels& levels) const;
};

std::string hex(uint64_t number);  // 16 digits
std::optional<uint64_t> number_of_hex(std::string_view text);

std::string outline_json(const Outline& outline);
// Nothing: it is no such file.
std::optional<Outline> read_outline(const std::string& text);

// The cases of an outline in their order, each once.
class Plan {
 public:
  explicit Plan(const Outline& outline);

  uint64_t size() const { return cases_.size(); }
  uint64_t left_out() const { return left_out_; }  // they would have come twice
  uint64_t case_at(uint64_t rank) const { return cases_[rank].id; }
  void levels(uint64_t rank, Levels& levels) const { design_.levels(cases_[rank].number, levels); }

 private:
  struct Case {
    uint64_t id;
    uint64_t number;  // of the design
  };
  Design design_;
  std::vector<Case> cases_;
  uint64_t left_out_ = 0;
};

}  // namespace ipos::tools::campaign
