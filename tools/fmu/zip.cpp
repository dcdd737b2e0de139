// Local headers, data, the central directory and its end.
#include "tools/fmu/zip.hpp"

#include <zlib.h>

#include <cstdint>
#include <initializer_list>

#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

constexpr uint16_t kDeflated = 8, kVersion = 20, kUtf8 = 1 << 11, kMadeByUnix = 3 << 8;
constexpr uint16_t kFirstDay = 1 << 5 | 1;  // 1980-01-01, the first there is
constexpr uint32_t kPlain = 0100644, kExecutable = 0100755;

void put(std::string& out, std::initializer_list<std::pair<uint32_t, int>> numbers) {
  for (const auto& [number, bytes] : numbers)
    for (int n = 0; n < bytes; ++n) out += static_cast<char>(number >> (8 * n));
}

std::string deflated(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Failure(kInternal, "zlib does not begin");
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), 0);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Failure(kInternal, "zlib does not end");
  return out;
}

}  // namespace

void Zip::add(const std::string& name, std::string_view bytes, bool executable) {
  const std::string packed = deflated(bytes);
  const auto crc = static_cast<uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  const auto size = static_cast<uint32_t>(bytes.size()), packed_size = static_cast<uint32_t>(packed.size());
  const auto name_size = static_cast<uint32_t>(name.size()), place = static_cast<uint32_t>(files_.size());
  put(files_, {{0x04034B50, 4}, {kVersion, 2}, {kUtf8, 2}, {kDeflated, 2}, {0, 2}, {kFirstDay, 2}, {crc, 4},
               {packed_size, 4}, {size, 4}, {name_size, 2}, {0, 2}});
  files_ += name;
  files_ += packed;
  put(directory_, {{0x02014B50, 4}, {kMadeByUnix | kVersion, 2}, {kVersion, 2}, {kUtf8, 2}, {kDeflated, 2}, {0, 2},
                   {kFirstDay, 2}, {crc, 4}, {packed_size, 4}, {size, 4}, {name_size, 2}, {0, 2}, {0, 2}, {0, 2}, {0, 2},
                   {(executable ? kExecutable : kPlain) << 16U, 4}, {place, 4}});
  directory_ += name;
  ++count_;
}

std::string Zip::finish() {
  const auto place = static_cast<uint32_t>(files_.size()), size = static_cast<uint32_t>(directory_.size());
  std::string out = std::move(files_) + directory_;
  put(out, {{0x06054B50, 4}, {0, 2}, {0, 2}, {count_, 2}, {count_, 2}, {size, 4}, {place, 4}, {0, 2}});
  return out;
}

}  // namespace ipos::tools
