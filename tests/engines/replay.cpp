// ipos_engines_replay FILE: all engines on programs that ipos_engines --write has made, for processors the
// compiler is not built for. Exit code 1 when they differ, or when there was no machine code for most.
#include <cstdio>
#include <fstream>

#include "tests/engines/campaign.hpp"

int main(int argc, char** argv) {
  std::ifstream in(argc > 1 ? argv[1] : "");
  ipos::tests::EngineCampaign campaign;
  for (ipos::tests::EngineProgram program; read(in, program);) campaign.run(program);
  std::printf("%s\n", campaign.summary().c_str());
  return campaign.difference.empty() && in.eof() && campaign.native * 2 > campaign.programs ? 0 : 1;
}
