// Documents, folders and the programs made of them.
#include "tools/lsp/workspace.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "runtime/signals/find.hpp"
#include "runtime/unit/program_image.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/lsp/plant_document.hpp"

namespace ipos::tools::lsp {
namespace {

namespace fs = std::filesystem;

// A folder tree larger than that is not searched to its end (ours).
constexpr size_t kMaxEntries = 50'000;
constexpr size_t kMaxPrograms = 2'000;

std::vector<std::string> strings(const Json& options, const char* name) {
  std::vector<std::string> out;
  const auto found = options.find(name);
  if (found == options.end() || !found->is_array()) return out;
  for (const Json& one : *found)
    if (one.is_string()) out.push_back(one.get<std::string>());
  return out;
}

void find_files(const std::string& folder, std::vector<std::string>& programs,
                std::vector<std::string>& tomls) {
  std::error_code error;
  size_t entries = 0;
  auto at = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator() && ++entries < kMaxEntries &&
         programs.size() < kMaxPrograms;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (at->is_directory(ignored) && (name.starts_with('.') || name == "node_modules" || name == "build"))
      at.disable_recursion_pending();
    else if (is_program(name) && at->is_regular_file(ignored))
      programs.push_back(at->path().generic_string());
    else if (name.ends_with(".toml") && at->is_regular_file(ignored))
      tomls.push_back(at->path().generic_string());
  }
}

}  // namespace

bool is_program(std::string_view path) {
  if (path.size() < 4) return false;
  std::string ending(path.substr(path.size() - 4));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return ending == ".IPC";
}

void Workspace::set_folders(std::vector<std::string> folders) {
  folders_ = std::move(folders);
  sources_.reset();
}

void Workspace::set_options(const Json& options) {
  compiler::CompileOptions made;
  if (options.is_object()) {
    for (const std::string& directory : strings(options, "includeDirs"))
      made.include_dirs.push_back(
          directory.starts_with('/') || folders_.empty() ? directory : folders_[0] + "/" + directory);
    made.defines = strings(options, "defines");
    for (const std::string& warning : strings(options, "warnings"))
      if (!made.warnings.apply(warning))
        throw RequestError(ErrorCode::InvalidParams, "there is no warning -W" + warning);
    const auto atomic = options.find("atomic");
    made.atomic = atomic != options.end() && atomic->is_boolean() && atomic->get<bool>();
    const auto unit = options.find("unit");
    if (unit != options.end() && unit->is_string() && !unit->get<std::string>().empty()) {
      made.unit = stdlib::find_unit_or_plate(std::string_view(unit->get_ref<const std::string&>()));
      if (made.unit == nullptr || made.unit->tasks == 0)
        throw RequestError(ErrorCode::InvalidParams,
                           "'" + unit->get<std::string>() + "' is no unit type with IPOS");
    }
  }
  options_ = std::move(made);
  programs_.clear();
}

void Workspace::open(const std::string& path, std::string text) {
  documents_[path] = std::move(text);
  forget(path);
}

void Workspace::change(const std::string& path, const Json& changes) {
  const auto document = documents_.find(path);
  if (document == documents_.end()) return;
  std::string& text = document->second;
  for (const Json& change : changes) {
    if (!change.is_object() || !change.contains("text") || !change["text"].is_string()) continue;
    const std::string& added = change["text"].get_ref<const std::string&>();
    const auto range = change.find("range");
    if (range == change.end() || !range->is_object()) {
      text = added;
      continue;
    }
    const uint32_t begin = offset_of(text, range->value("start", Json()), encoding);
    const uint32_t end = std::max(begin, offset_of(text, range->value("end", Json()), encoding));
    text.replace(begin, end - begin, added);
  }
  forget(path);
}

void Workspace::close(const std::string& path) {
  documents_.erase(path);
  forget(path);
}

void Workspace::touched(const std::string& path) {
  sources_.reset();
  if (!is_open(path)) forget(path);
}

// Programs that read the file, and those that look for one in vain.
void Workspace::forget(const std::string& path) {
  std::erase_if(programs_, [&](const auto& entry) {
    const Program& program = *entry.second;
    if (program.path == path || program.files.contains(path)) return true;
    return std::any_of(program.compiled.diagnostics.all().begin(), program.compiled.diagnostics.all().end(),
                       [](const auto& one) { return one.diag == compiler::Diag::IncludeNotFound; });
  });
}

std::vector<std::string> Workspace::open_documents() const {
  std::vector<std::string> out;
  for (const auto& [path, text] : documents_) out.push_back(path);
  return out;
}

std::optional<std::string> Workspace::text(const std::string& path) const {
  const auto document = documents_.find(path);
  if (document != documents_.end()) return document->second;
  return read_file_(path);
}

Program Workspace::compile(const std::string& path, const std::map<std::string, std::string>& texts) const {
  Program program;
  program.path = path;
  compiler::CompileOptions options = options_;
  options.is_unit_value = signals::is_unit_value;
  options.read_file = [this, &texts](const std::string& wanted) {
    // "/a/../b" and "/b" are one file to the editor.
    const std::string clean = tidy(wanted);
    const auto other = texts.find(clean);
    return other != texts.end() ? std::optional(other->second) : text(clean);
  };
  const std::string source = options.read_file(path).value_or("");
  auto [compiled, index] = compiler::compile_indexed(path, path, source, options);
  program.compiled = std::move(compiled);
  program.index = std::move(index);
  for (const auto& file : program.index.sources->files())
    if (!file->path.empty()) program.files.insert(tidy(file->path));
  return program;
}

std::optional<vm::Image> Workspace::image(const std::string& path, const stdlib::UnitType* unit) const {
  const auto source = text(path);
  if (!source) return std::nullopt;
  if (!is_program(path)) {
    auto read = runtime::read_program_image({reinterpret_cast<const uint8_t*>(source->data()), source->size()});
    return read ? std::optional(*std::move(read)) : std::nullopt;
  }
  compiler::CompileOptions options = options_;
  if (unit != nullptr) options.unit = unit;
  options.read_file = [this](const std::string& wanted) { return text(tidy(wanted)); };
  return compiler::compile(path, path, *source, options).image;
}

const Program& Workspace::cached(const std::string& path) {
  std::unique_ptr<Program>& program = programs_[path];
  if (!program) program = std::make_unique<Program>(compile(path));
  return *program;
}

void Workspace::look_into_folders() {
  if (sources_) return;
  sources_.emplace();
  toml_files_.clear();
  for (const std::string& folder : folders_) find_files(folder, *sources_, toml_files_);
  std::sort(sources_->begin(), sources_->end());
}

std::vector<std::string> Workspace::plants() {
  look_into_folders();
  std::set<std::string> all(toml_files_.begin(), toml_files_.end());
  for (const auto& [path, text] : documents_)
    if (path.ends_with(".toml")) all.insert(path);
  std::vector<std::string> found(all.begin(), all.end());
  std::erase_if(found, [this](const std::string& path) { return !is_plant_document(*this, path); });
  return found;
}

std::vector<std::string> Workspace::sources() {
  look_into_folders();
  std::set<std::string> all(sources_->begin(), sources_->end());
  for (const auto& [path, text] : documents_)
    if (is_program(path)) all.insert(path);
  return {all.begin(), all.end()};
}

std::vector<const Program*> Workspace::programs() {
  std::vector<const Program*> out;
  for (const std::string& path : sources()) out.push_back(&cached(path));
  return out;
}

std::vector<const Program*> Workspace::programs_with(const std::string& path) {
  std::vector<const Program*> out = programs();
  std::erase_if(out, [&](const Program* one) { return !one->files.contains(path); });
  return out;
}

const Program& Workspace::program(const std::string& path) {
  if (is_program(path)) return cached(path);
  const auto all = programs_with(path);
  const auto open =
      std::find_if(all.begin(), all.end(), [&](const Program* one) { return is_open(one->path); });
  if (open != all.end()) return **open;
  return all.empty() ? cached(path) : *all.front();
}

}  // namespace ipos::tools::lsp
