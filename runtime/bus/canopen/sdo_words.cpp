// SDO requests and responses in words, with the names and values of the objects.
#include <fmt/format.h>

#include "runtime/bus/canopen/words.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime::canopen {
namespace {

std::string object_text(const NodeName& name, Address address) {
  const std::string place = address.sub == 0 ? fmt::format("{:04X}h", address.index)
                                             : fmt::format("{:04X}h:{}", address.index, address.sub);
  std::string called = entry_name(address);
  if (called.empty() && address.sub == 0 && address.index >= objects::kOutput)
    called = stdlib::index_name(stdlib::parameter_table(*name.unit), address.index);
  return called.empty() ? place : fmt::format("{} {}", place, called);
}

std::string value_text(const NodeName& name, Address address, uint32_t value, size_t bytes) {
  const stdlib::Parameter* parameter = stdlib::parameter_table(*name.unit).find(address.index);
  if (parameter != nullptr && address.sub == 0 && bytes == 4)
    return stdlib::parameter_text(*parameter, static_cast<int32_t>(value));
  if (bytes == 4 && address.index < objects::kOutput) return fmt::format("{:08X}h", value);
  return bytes == 4 ? fmt::format("{}", static_cast<int32_t>(value)) : fmt::format("{}", value);
}

// The characters of a segment; other bytes as numbers.
std::string segment_text(const SdoBytes& bytes) {
  const size_t length = sdo::kSegment - sdo::unused_of_seven(bytes[0]);
  std::string text;
  bool printable = true;
  for (size_t n = 1; n <= length; ++n) {
    printable = printable && bytes[n] >= 0x20 && bytes[n] < 0x7F;
    text += static_cast<char>(bytes[n]);
  }
  if (printable) return fmt::format("\"{}\"", text);
  text.clear();
  for (size_t n = 1; n <= length; ++n) text += fmt::format("{}{:02X}", n == 1 ? "" : " ", bytes[n]);
  return text;
}

std::string_view last_text(const SdoBytes& bytes) { return (bytes[0] & sdo::kLast) != 0 ? ", the last" : ""; }

std::string abort_words(const NodeName& name, const SdoBytes& bytes) {
  const uint32_t code = sdo::data_of(bytes);
  const std::string_view text = abort_text(code);
  return fmt::format("SDO abort {}: {} ({:08X}h)", object_text(name, sdo::address_of(bytes)),
                     text.empty() ? "unknown reason" : text, code);
}

struct Expedited {
  size_t bytes;
  uint32_t value;
};
Expedited expedited(const SdoBytes& bytes) {
  const size_t unused = (bytes[0] & sdo::kSized) != 0 ? sdo::unused_of_four(bytes[0]) : 0U;
  return {4 - unused, unused == 0 ? sdo::data_of(bytes) : sdo::data_of(bytes) & (0xFFFF'FFFFU >> 8 * unused)};
}

}  // namespace

std::string LineWords::sdo_request_text(Listened& node, const SdoBytes& bytes) {
  const Address address = sdo::address_of(bytes);
  const auto transfer = [&] {
    return node.transfer ? object_text(node.name, *node.transfer) : "an unknown object";
  };
  const sdo::Ask ask = sdo::ask_of(bytes);
  if (ask != sdo::Ask::DownloadSegment && ask != sdo::Ask::UploadSegment) {
    node.written.reset();
    node.transfer = address;
  }
  switch (ask) {
    case sdo::Ask::Upload: return fmt::format("SDO read {}", object_text(node.name, address));
    case sdo::Ask::Download: {
      if ((bytes[0] & sdo::kExpedited) == 0)
        return fmt::format("SDO write {} in segments", object_text(node.name, address));
      const Expedited data = expedited(bytes);
      node.written = data.value;
      return fmt::format("SDO write {} = {}", object_text(node.name, address),
                         value_text(node.name, address, data.value, data.bytes));
    }
    case sdo::Ask::UploadSegment: return fmt::format("SDO next segment of {}", transfer());
    case sdo::Ask::DownloadSegment:
      return fmt::format("SDO segment {} of {}{}", segment_text(bytes), transfer(), last_text(bytes));
    case sdo::Ask::Abort: return abort_words(node.name, bytes);
    case sdo::Ask::BlockUpload: return fmt::format("SDO block read {}", object_text(node.name, address));
    case sdo::Ask::BlockDownload: return fmt::format("SDO block write {}", object_text(node.name, address));
    case sdo::Ask::None: break;
  }
  return fmt::format("SDO unknown command {:02X}h", bytes[0]);
}

std::string LineWords::sdo_response_text(Listened& node, const SdoBytes& bytes) {
  const Address address = sdo::address_of(bytes);
  const auto transfer = [&] {
    return node.transfer ? object_text(node.name, *node.transfer) : "an unknown object";
  };
  switch (sdo::answer_of(bytes)) {
    case sdo::Answer::Upload: {
      if ((bytes[0] & sdo::kExpedited) == 0)
        return fmt::format("SDO {} has {} bytes, in segments", object_text(node.name, address),
                           sdo::data_of(bytes));
      const Expedited data = expedited(bytes);
      return fmt::format("SDO {} = {}", object_text(node.name, address),
                         value_text(node.name, address, data.value, data.bytes));
    }
    case sdo::Answer::Download:
      if (node.written && node.transfer == address && node.dictionary.find(address) != nullptr) {
        node.dictionary.set(address, *node.written);
        find_messages();
      }
      node.written.reset();
      return fmt::format("SDO written {}", object_text(node.name, address));
    case sdo::Answer::UploadSegment:
      return fmt::format("SDO segment {} of {}{}", segment_text(bytes), transfer(), last_text(bytes));
    case sdo::Answer::DownloadSegment: return fmt::format("SDO segment taken of {}", transfer());
    case sdo::Answer::Abort: return abort_words(node.name, bytes);
    case sdo::Answer::BlockDownload:
    case sdo::Answer::BlockUpload:
    case sdo::Answer::None: break;
  }
  return fmt::format("SDO unknown answer {:02X}h", bytes[0]);
}

}  // namespace ipos::runtime::canopen
