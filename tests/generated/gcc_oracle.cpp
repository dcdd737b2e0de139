// A folder of its own below the system's temporary folder holds the C file and the program; it is removed
// again.
#include "tests/generated/gcc_oracle.hpp"

#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/generated/c_text.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "ipos_generated_XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

int run(const std::string& command, std::string& output) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  char buffer[4096];
  while (const size_t n = fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, n);
  return pclose(pipe);
}

Outcome parse(const std::string& line, int32_t variables) {
  Outcome out;
  out.ended = true;
  out.variables.resize(static_cast<size_t>(variables));
  std::istringstream in(line);
  in >> out.fault >> out.line;
  size_t number = 0;
  char sign = 0;
  int32_t value = 0;
  while (in >> number >> sign >> value) out.variables.at(number) = value;
  return out;
}

}  // namespace

bool gcc_present() {
  std::string version;
  return run("gcc --version 2>/dev/null", version) == 0;
}

GccRun run_with_gcc(const std::vector<Program>& programs) {
  GccRun out;
  const Folder folder;
  if (folder.path().empty()) return {{}, "no temporary folder"};
  const std::string source = folder.path() + "/programs.c";
  std::ofstream(source) << c_text(programs);
  std::string output;
  if (run("gcc -O0 -w -fwrapv -fno-strict-aliasing -o " + folder.path() + "/programs " + source + " 2>&1",
          output))
    return {{}, "gcc refuses the programs:\n" + output};
  output.clear();
  if (run(folder.path() + "/programs", output) != 0) return {{}, "the C programs did not end well"};
  std::istringstream lines(output);
  std::string line;
  while (out.outcomes.size() < programs.size() && std::getline(lines, line))
    out.outcomes.push_back(parse(line, programs[out.outcomes.size()].variables));
  if (out.outcomes.size() != programs.size())
    out.trouble = "lines are missing in the output of the C programs";
  return out;
}

}  // namespace ipos::tests
