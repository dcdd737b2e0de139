// A telegram of a log field by field, for programs: what `ipos bus decode --format json` prints before its text, and
// what the Wireshark dissector is compared with. Numbers are those of the wire.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/logs/log_forms.hpp"

namespace ipos::tools {

nlohmann::ordered_json telegram_json(const runtime::LogEntry& entry);
nlohmann::ordered_json telegram_json(const runtime::SerialEntry& entry);
nlohmann::ordered_json telegram_json(const runtime::ProfibusEntry& entry);

}  // namespace ipos::tools
