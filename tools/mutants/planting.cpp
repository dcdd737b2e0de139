// Mistakes of all programs together; the same place of a header is one.
#include "tools/mutants/planting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

#include "runtime/unit/unit.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/program.hpp"
#include "tools/mutants/marks.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tools::mutants {
namespace {

using compiler::Location;
using compiler::mutants::Change;

std::string plain(const std::string& path) { return std::filesystem::path(path).lexically_normal().generic_string(); }

Lines lines_of(compiler::Span span, const compiler::SourceMap& sources) {
  const compiler::Position first = sources.position(span.begin);
  const compiler::Position last = sources.position(span.end);
  return {plain(first.file->path), first.line, std::max(first.line, last.file == first.file ? last.line : 0)};
}

// Not where it stands in the #define of what is used there.
bool holds(const Lines& lines, const Mutant& mutant) {
  return lines.file == mutant.file && lines.first <= mutant.place.line && mutant.place.line <= lines.last;
}

// A unit decides what a variable and a command are, so each has a build of its own.
std::set<testing::ProgramName> programs_of(const std::vector<testing::TestCase>& tests) {
  std::set<testing::ProgramName> names;
  for (const testing::TestCase& test : tests)
    for (const runtime::StationConfig& station : test.plant.stations)
      if (!station.program.empty() && is_source(station.program))
        names.insert({beside(test.plant_path, station.program), station.unit});
  return names;
}

}  // namespace

PlantedProgram::PlantedProgram(testing::ProgramName name, compiler::Compilation compiled, compiler::GenerateOptions options)
    : name_(std::move(name)),
      compiled_(std::move(compiled)),
      options_(options),
      changes_(compiler::mutants::find_changes(*compiled_.program, *compiled_.sources)) {}

std::optional<vm::Image> PlantedProgram::image_with(size_t change) {
  const std::lock_guard lock(mutex_);
  compiler::Diagnostics diagnostics;
  changes_[change].toggle();
  auto generated = compiler::generate(*compiled_.program, *compiled_.unit, *compiled_.sources, options_, diagnostics);
  changes_[change].toggle();
  if (!generated || diagnostics.has_errors() || generated->image.code == compiled_.image->code) return std::nullopt;
  const vm::Limits limits = runtime::limits_of(*compiled_.unit);
  if (!vm::verify(generated->image.code, limits, {}).image) return std::nullopt;
  return std::move(generated->image);
}

Planting::Planting(const std::vector<testing::TestCase>& tests, const CompileFlags& flags) {
  for (const testing::ProgramName& name : programs_of(tests)) {
    const auto text = load_file(name.first);
    if (!text) continue;
    compiler::Compilation compiled = testing::compile_for_test(name, *text, flags);
    if (!compiled.image) continue;
    programs_.push_back(std::make_unique<PlantedProgram>(name, std::move(compiled), compiler::GenerateOptions{flags.atomic, flags.optimization == "0"}));
    find(*programs_.back());
  }
  leave_out_doubles();
  take_marks();
}

std::map<std::string, std::string> Planting::sources() const {
  std::map<std::string, std::string> sources;
  for (const auto& program : programs_)
    for (const auto& file : program->sources().files())
      if (!file->path.empty()) sources.emplace(plain(file->path), file->text);
  return sources;
}

void Planting::find(PlantedProgram& program) {
  const compiler::SourceMap& sources = program.sources();
  for (size_t n = 0; n < program.changes().size(); ++n) {
    const Change& change = program.changes()[n];
    const compiler::Position at = sources.position(change.at);
    Planted planted;
    planted.mutant = {plain(at.file->path), {at.line, at.column}, change.kind, change.text, Fate::NotRun, {}};
    const auto [known, is_new] =
        known_.try_emplace({planted.mutant.file, at.line, at.column, change.text}, mutants_.size());
    if (is_new) mutants_.push_back(std::move(planted));
    Planted& one = mutants_[known->second];
    one.in.emplace_back(&program, n);
    for (const compiler::mutants::Site& site : change.sites) {
      one.executed.push_back(lines_of(site.executed, sources));
      one.functions.push_back(lines_of(site.function, sources));
    }
  }
}

// What cannot be seen is not planted: the same code as without it, or as with another mistake.
void Planting::leave_out_doubles() {
  std::stable_sort(mutants_.begin(), mutants_.end(), [](const Planted& a, const Planted& b) {
    return std::tie(a.mutant.file, a.mutant.place.line, a.mutant.place.column) <
           std::tie(b.mutant.file, b.mutant.place.line, b.mutant.place.column);
  });
  std::set<std::vector<uint32_t>> seen;
  std::erase_if(mutants_, [&](Planted& planted) {
    std::vector<uint32_t> code;  // of all programs that have it, each behind its number
    std::erase_if(planted.in, [&](const auto& in) {
      const auto image = in.first->image_with(in.second);
      if (!image) return true;
      const auto number = std::find_if(programs_.begin(), programs_.end(), [&](const auto& one) { return one.get() == in.first; });
      code.push_back(static_cast<uint32_t>(number - programs_.begin()));
      code.insert(code.end(), image->code.begin(), image->code.end());
      return false;
    });
    return planted.in.empty() || !seen.insert(std::move(code)).second;
  });
}

// A mark takes out what is planted into the statement in front of it, and what stands on its line.
void Planting::take_marks() {
  std::map<std::string, std::map<uint32_t, Mark>> marks;
  std::set<std::pair<std::string, uint32_t>> used;
  for (const auto& program : programs_)
    for (const auto& file : program->sources().files())
      if (!file->path.empty()) marks[plain(file->path)] = marks_of(file->text);
  const auto take = [&](Mutant& mutant, const Lines& lines) {
    const auto of_file = marks.find(lines.file);
    if (of_file == marks.end()) return;
    for (auto mark = of_file->second.lower_bound(lines.first); mark != of_file->second.end() && mark->first <= lines.last; ++mark) {
      used.emplace(lines.file, mark->first);
      if (mark->second.reason.empty()) continue;
      mutant.fate = Fate::Equivalent;
      mutant.because = mark->second.reason;
    }
  };
  for (Planted& planted : mutants_) {
    take(planted.mutant, {planted.mutant.file, planted.mutant.place.line, planted.mutant.place.line});
    for (const auto& [program, change] : planted.in)
      for (const compiler::mutants::Site& site : program->changes()[change].sites)
        if (const Lines lines = lines_of(site.text, program->sources()); holds(lines, planted.mutant))
          take(planted.mutant, lines);
  }
  for (const auto& [file, of_file] : marks)
    for (const auto& [line, mark] : of_file)
      if (mark.reason.empty() || !used.contains({file, line}))
        notes_.push_back(fmt::format("{}:{}:{}: {}", file, line, mark.column,
                                     mark.reason.empty() ? "`// equivalent:` needs a reason behind it"
                                                         : "`// equivalent` stands behind nothing that could be wrong"));
}

}  // namespace ipos::tools::mutants
