// The examples, compiled into the program once: `ipos new --from` copies one, the gallery of the page shows and opens them.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools {

// Text by path, as a folder is filled with them.
using NewFiles = std::map<std::string, std::string_view>;

struct Example {
  std::string name;   // of its folder
  std::string plant;  // its plant file
  std::string story;  // what stands at the head of the plant file, its first sentences
  std::string kind;   // what it is made of: "2 x mdxb on sbus (can)"
  NewFiles files;
};

// In the order of their names.
const std::vector<Example>& all_examples();
// Null: there is none.
const Example* find_example(std::string_view name);

// What `ipos new` begins with: plant, programs, test, files for CI servers, under the names of the template.
NewFiles template_files();
inline constexpr std::string_view kEmptyProgram =
    "#include <constb.h>\n#include <iob.h>\n\nmain()\n{\n    while (1)\n    {\n    }\n}\n";

// Writes them all; a Failure says which is there already, and then none was written.
void write_new_files(const std::string& folder, const NewFiles& files);

}  // namespace ipos::tools
