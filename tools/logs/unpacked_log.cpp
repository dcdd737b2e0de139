// Logs packed with gzip, as python-can and logrotate write them.
#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/files.hpp"
#include "tools/logs/log_forms.hpp"
#include "tools/packing/unpack.hpp"

namespace ipos::tools {

tl::expected<UnpackedLog, std::string> unpacked_log(std::string_view packed) {
  // Logs become 5 to 20 times smaller; a short one may be all the same (ours).
  constexpr size_t kMostTimes = 32, kAlwaysGood = size_t{1} << 20U;
  const size_t limit = std::min(std::max(packed.size() * kMostTimes, kAlwaysGood), kLogLimit);
  UnpackedLog log;
  std::string& out = log.bytes;
  const Unpacked end = unpack(packed, Packing::Gzip, [&](std::string_view piece) {
    out += piece;
    return out.size() <= limit;
  });
  if (out.size() > limit)
    return tl::unexpected(fmt::format("unpacks to more than {} bytes, which no log does", limit));
  if (end == Unpacked::Damaged) return tl::unexpected(std::string("packed with gzip, and damaged"));
  log.whole = end == Unpacked::Whole;
  // Half a line may look like a whole one.
  const LogForm form = log_form(out);
  if (!log.whole && (form == LogForm::Lines || form == LogForm::Asc || form == LogForm::Trc))
    out.resize(out.rfind('\n') + 1);  // to nothing where there is no line
  return log;
}

}  // namespace ipos::tools
