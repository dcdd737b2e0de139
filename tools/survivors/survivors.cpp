// JSON with the whole text of the source: it is compared, so that nothing is shown at lines that have moved.
#include "tools/survivors/survivors.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/cli/cache.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/cli/xml_text.hpp"

namespace ipos::tools {
namespace {

using nlohmann::json;

// However the source is named, and whether or not a link leads to it.
std::string whole(const std::string& source) {
  std::error_code error;
  const auto path = std::filesystem::weakly_canonical(std::filesystem::absolute(source, error), error);
  return utf8(path.generic_string());
}

}  // namespace

void keep_survivors(const std::string& source, std::string_view text, const std::vector<Survivor>& survivors) {
  const std::string name = whole(source);
  if (survivors.empty()) return write_cache("survivors", name, "");
  json kept{{"source", name}, {"text", utf8(std::string(text))}, {"survivors", json::array()}};
  for (const Survivor& one : survivors)
    kept["survivors"].push_back({{"line", one.line}, {"column", one.column}, {"text", utf8(one.text)}, {"reached", one.reached}});
  write_cache("survivors", name, json_text(kept, 1) + "\n");
}

std::vector<Survivor> kept_survivors(const std::string& source, std::string_view text) {
  std::vector<Survivor> survivors;
  const std::string name = whole(source);
  const json kept = json::parse(read_cache("survivors", name), nullptr, false);
  try {
    if (kept.at("source") != name || kept.at("text") != utf8(std::string(text))) return survivors;
    for (const json& one : kept.at("survivors"))
      survivors.push_back({one.at("line"), one.at("column"), one.at("text"), one.at("reached")});
  } catch (const json::exception&) {  // not there, or not ours
    survivors.clear();
  }
  return survivors;
}

}  // namespace ipos::tools
