// The compiler's renderer quotes the lines; the parser of TOML counts columns in characters, it counts bytes.
#include "tools/input/mistakes.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/diag/render.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/cli/text_lines.hpp"

namespace ipos::tools {
namespace {

size_t bytes_before(std::string_view line, uint32_t column) {
  size_t at = 0;
  for (uint32_t n = 1; n < column && at < line.size(); ++n) do
      ++at;
    while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U);
  return at;
}

}  // namespace

std::string mistakes_text(const std::string& path, const std::vector<runtime::PlantError>& errors,
                          bool colours) {
  const auto lines = text_lines(errors.empty() ? "" : try_read_file(path).value_or(""));
  std::string out;
  for (const runtime::PlantError& error : errors) {
    const runtime::FilePlace place = error.place;
    const std::string place_text = fmt::format("{}:{}:{}:", path, place.line, place.column);
    std::string_view line;
    if (place.line != 0 && place.line <= lines.size()) line = lines[place.line - 1];
    out += compiler::render_mistake(place_text, error.text, place.line, line,
                                    bytes_before(line, place.column), colours);
  }
  return out;
}

void print_mistakes(const std::string& path, const std::vector<runtime::PlantError>& errors) {
  fmt::print(stderr, "{}", mistakes_text(path, errors, has_colours(STDERR_FILENO)));
}

}  // namespace ipos::tools
