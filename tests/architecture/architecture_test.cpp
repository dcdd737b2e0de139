// The include arrows hold: for each row of arrows.tsv a one-line source is compiled with exactly the include
// roots of the layer; rows marked "blind" must fail because the header is not found.
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Arrow {
  std::string layer;
  bool sees;
  std::string header;
};

std::vector<Arrow> arrows() {
  std::vector<Arrow> rows;
  std::ifstream in(IPOS_ARROWS);
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string layer, word, header;
    fields >> layer >> word >> header;
    rows.push_back({layer, word == "sees", header});
  }
  return rows;
}

struct Compilation {
  bool ok;
  std::string messages;
};

Compilation compile(const std::string& layer, const std::string& header) {
  const std::string source = std::string(IPOS_FLAGS_DIR) + "/" + layer + "_arrow.cpp";
  std::ofstream(source) << "#include \"" << header << "\"\n";
  const std::string command = std::string("'") + IPOS_COMPILER + "' -std=c++20 -fsyntax-only '@" +
                              IPOS_FLAGS_DIR + "/" + layer + ".flags' '" + source + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {false, "cannot start the compiler"};
  std::string messages;
  std::array<char, 512> buffer;
  while (const size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    messages.append(buffer.data(), n);
  return {pclose(pipe) == 0, messages};
}

class IncludeArrow : public ::testing::TestWithParam<Arrow> {};

TEST_P(IncludeArrow, Holds) {
  const Arrow& arrow = GetParam();
  namespace fs = std::filesystem;
  if (!fs::exists(std::string(IPOS_FLAGS_DIR) + "/" + arrow.layer + ".flags"))
    GTEST_SKIP() << "this build has no layer " << arrow.layer;
  // A header that does not exist at all would make every "blind" row true.
  ASSERT_TRUE(fs::exists(std::string(IPOS_SOURCE_DIR) + "/" + arrow.header))
      << arrow.header << " does not exist";
  const Compilation result = compile(arrow.layer, arrow.header);
  if (arrow.sees) {
    EXPECT_TRUE(result.ok) << result.messages;
  } else {
    EXPECT_FALSE(result.ok) << arrow.layer << " can include " << arrow.header;
    EXPECT_NE(result.messages.find(arrow.header), std::string::npos) << result.messages;
    EXPECT_TRUE(result.messages.find("No such file") != std::string::npos ||
                result.messages.find("file not found") != std::string::npos)
        << result.messages;
  }
}

INSTANTIATE_TEST_SUITE_P(Layers, IncludeArrow, ::testing::ValuesIn(arrows()), [](const auto& row) {
  std::string name = row.param.layer + (row.param.sees ? "_sees_" : "_is_blind_to_") + row.param.header;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
