// Variable objects across a plant: what one program sends and none receives, expects and none sends, or receives in another
// form. The code of the programs tells, without a run; where it leaves anything open, nothing is said.
#pragma once

#include <string>
#include <vector>

#include "runtime/bus_plan/plan.hpp"
#include "tools/input/record.hpp"

namespace ipos::tools {

struct ObjectFinding {
  runtime::Finding finding;
  Told place;  // with the text of the finding; `file` is empty where the image has no lines
};

// Of all CAN lines. Who sends and who receives is certain on a line that has no control, no gateway and no real port, and where
// the code of each program gives every _SBusCommDef its object as a constant.
std::vector<ObjectFinding> object_findings(const runtime::Plant& plant);

// "B.IPC:6:3: warning: nobody on sbus sends object ... [B29]"
std::string text_of(const ObjectFinding& one);

// As warnings at the places of the commands; on standard error where there is no record.
void tell_objects(const runtime::Plant& plant, BuildRecord* record = nullptr);

}  // namespace ipos::tools
