// New tables of the plant file by forms: what a form asks, and the table in the file, with its program.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/serve/host/plant_form.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

class FormTab final : public Tab {
 public:
  explicit FormTab(PlantHost& host) : host_(host) {
    host.router().add_command("form", [this](const Router::Call& call) {
      Json form = plant_form(text_of(plant_file()), call.arguments);
      form["templates"] = Json::array();
      for (const auto& [name, text] : host_.files().templates()) form["templates"].push_back(name);
      form["programs"] = programs();
      return form;
    });
    host.router().add_command("form.insert", [this](const Router::Call& call) { return insert(call.arguments); });
  }

 private:
  std::string plant_file() {
    for (const Files::Entry& entry : host_.files().list())
      if (entry.kind == Files::Kind::Plant) return entry.name;
    throw Mistake("this page shows a single program; a plant with several stations needs a plant file");
  }
  std::string text_of(const std::string& file) {
    auto text = host_.files().text(file);
    if (!text) throw Mistake(fmt::format("{} cannot be read", file));
    return *std::move(text);
  }
  static std::string beside(const std::string& plant, const std::string& name) {
    return (std::filesystem::path(plant).parent_path() / name).generic_string();
  }

  // Of the stations that are there, as the plant names them.
  Json programs() {
    Json names = Json::array();
    for (const runtime::StationConfig& station : host_.plant().file().stations)
      if (!station.program.empty() && std::find(names.begin(), names.end(), Json(station.program)) == names.end())
        names.push_back(station.program);
    return names;
  }

  // The plant names the program first, so that it belongs to it. Where that cannot be written the plant is the old one.
  Json insert(const Arguments& a) {
    const std::string file = plant_file();
    const std::string before = text_of(file);
    const std::string after = with_table(before, a);
    const std::string program = a.text("program", "");
    const std::string place = program.empty() ? "" : beside(file, program);
    host_.files().write(file, after);
    if (program.empty()) return {{"file", file}};
    try {
      if (host_.files().text(place)) throw Mistake(fmt::format("{} is there already; take it as it is, or another name", program));
      const Texts templates = host_.files().templates();
      const auto from = templates.find(a.text("template", ""));
      if (from == templates.end()) throw Mistake("'template' names none of the templates");
      host_.files().write(place, from->second);
    } catch (...) {
      host_.files().write(file, before);
      throw;
    }
    return {{"file", file}, {"program", place}};
  }

  PlantHost& host_;
};

}  // namespace

std::unique_ptr<Tab> make_form_tab(PlantHost& host) { return std::make_unique<FormTab>(host); }

}  // namespace ipos::tools::serve
