// Commands `gallery`, `gallery.open`, `gallery.new` and `form`. After one that opens a plant the page loads itself again, and
// finds the host of that plant.
#include "tools/serve/gallery_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "stdlib/plain_text.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/examples/examples.hpp"
#include "tools/serve/host/plant_form.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

// With a bus, which a plant of one station does not need.
constexpr std::string_view kNewPlant =
    "# A plant made on the page.\n[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n";

// A plain name in the folder.
std::string file_name(const std::string& name, std::string_view ending) {
  if (name.empty() || name.starts_with('.') || !stdlib::is_plain(name) || name.find_first_of("/\\") != std::string::npos)
    throw Mistake(fmt::format("'{}' is no name of a file", name));
  return name.ends_with(ending) ? name : name + std::string(ending);
}

// The programs that a station can begin with.
Json template_names() {
  Json names = Json::array();
  for (const auto& [name, text] : template_files())
    if (name.ends_with(".IPC")) names.push_back(name);
  return names;
}

}  // namespace

GalleryHost::GalleryHost(Outbox& outbox, const Clock& clock, Around around)
    : router_(outbox, clock), around_(std::move(around)) {
  router_.hello = [this] {
    return Json{{"protocol", 1}, {"version", around_.version}, {"mode", "gallery"}, {"title", "Gallery"}, {"writable", around_.read_only.empty()}};
  };
  router_.add_command("gallery", [this](const Router::Call&) { return list(); });
  router_.add_command("gallery.open", [this](const Router::Call& call) { return open(call.arguments); });
  router_.add_command("gallery.new", [this](const Router::Call& call) { return make(call.arguments); });
  router_.add_command("form", [](const Router::Call& call) {
    Json form = plant_form(std::string(kNewPlant), call.arguments);
    form["templates"] = template_names();
    return form;
  });
}

void GalleryHost::must_write() const {
  if (!around_.read_only.empty()) throw Mistake(around_.read_only);
}

Json GalleryHost::list() const {
  Json examples = Json::array();
  for (const Example& example : all_examples())
    if (!example.plant.empty()) examples.push_back({{"name", example.name}, {"story", example.story}, {"kind", example.kind}});
  return {{"examples", std::move(examples)}, {"here", around_.plants()}, {"templates", template_names()}};
}

// An example as a copy in `folder`, or one of the plants that are here.
Json GalleryHost::open(const Arguments& a) {
  if (a.has("here")) {
    const std::string path = a.text("here");
    const std::vector<std::string> plants = around_.plants();
    if (std::find(plants.begin(), plants.end(), path) == plants.end()) throw Mistake(fmt::format("there is no plant {} here", path));
    return enter(path);
  }
  must_write();
  const Example* example = find_example(a.text("name"));
  if (example == nullptr || example->plant.empty()) throw Mistake(fmt::format("there is no example '{}'", a.text("name")));
  const std::string folder = a.text("folder", "./" + example->name);
  try {
    write_new_files(folder, example->files);
  } catch (const Failure& failure) {
    throw Mistake(failure.what());
  }
  return enter((fs::path(folder) / example->plant).generic_string());
}

Json GalleryHost::enter(const std::string& path) {
  try {
    around_.build(path);
  } catch (const Failure& failure) {
    throw Mistake(*failure.what() != '\0' ? failure.what() : fmt::format("{} has mistakes: the terminal of ipos serve shows them", path));
  }
  opened_ = path;
  return {{"opened", path}};
}

// A plant with one station, from the form; its program from a template.
Json GalleryHost::make(const Arguments& a) {
  must_write();
  const std::string file = file_name(a.text("file"), ".toml");
  const std::string folder = a.text("folder", ".");
  const std::string text = with_table(std::string(kNewPlant), a);
  NewFiles files{{file, text}};
  const std::string program = a.has("program") ? file_name(a.text("program"), ".IPC") : "";
  const NewFiles templates = template_files();
  if (!program.empty()) {
    const auto from = templates.find(a.text("template", ""));
    files[program] = from == templates.end() ? kEmptyProgram : from->second;
  }
  try {
    write_new_files(folder, files);
  } catch (const Failure& failure) {
    throw Mistake(failure.what());
  }
  try {
    return enter((fs::path(folder) / file).generic_string());
  } catch (...) {  // it can be made again, another way
    for (const auto& [name, written] : files) fs::remove(fs::path(folder) / name);
    throw;
  }
}

}  // namespace ipos::tools::serve
