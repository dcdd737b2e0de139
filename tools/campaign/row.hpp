// A result as a line of JSON: written of an outcome, read again by `merge`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/outline.hpp"

namespace ipos::tools::campaign {

struct Row {
  uint64_t id = 0;
  std::vector<std::optional<double>> measures;  // as many as the outline has, or none
  std::vector<std::string> failed;
  std::string hash;

  bool operator==(const Row&) const = default;
};

// Lines of one campaign; what all of them share is made once.
class RowWriter {
 public:
  explicit RowWriter(const Outline& outline);

  // With the end of the line. Without `ms`, which is not part of a result, the same case gives the same bytes.
  void append(std::string& out, uint64_t id, const Levels& levels, const std::vector<std::optional<double>>& measures,
              const std::vector<std::string>& failed, const std::string& hash, std::optional<double> ms) const;

 private:
  const Outline& outline_;
  std::vector<std::vector<std::string>> factors_;  // `"name":value` of each level
  std::vector<std::string> measures_;              // `"name":`
};

std::string number_text(double number);

// Nothing: it is no whole line of a result.
std::optional<Row> read_row(const Outline& outline, std::string_view line);
// Without reading it all: the case, and whether it failed.
struct RowHead {
  uint64_t id;
  bool good;
};
std::optional<RowHead> read_row_head(std::string_view line);

}  // namespace ipos::tools::campaign
