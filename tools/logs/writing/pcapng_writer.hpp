// Writes pcapng: an interface a bus, then a packet a frame or telegram.
#pragma once

#include <span>
#include <utility>

#include "tools/logs/writing/pcapng.hpp"
#include "tools/logs/writing/writer.hpp"

namespace ipos::tools {

class PcapngWriter final : public LogWriter {
 public:
  // Lines that are known stand at the head; others are added when they are first heard.
  explicit PcapngWriter(std::ostream& out, const LogPart& part = {});
  void can(runtime::Time time, const std::string& bus, const runtime::Frame& frame) override;
  void can_error(const runtime::CanLine& line, const runtime::ErrorRecord& error) override;
  void serial(const std::string& line, const runtime::Reception& reception) override;
  void dp(const std::string& line, const profibus::Reception& reception) override;
  bool has_serial() const override { return true; }

 private:
  void packet(runtime::Time time, const std::string& bus, pcapng::LinkType link,
              std::span<const uint8_t> bytes, const std::string& comment = {});
  uint32_t interface_of(const std::string& bus, pcapng::LinkType link);
  void block(uint32_t type, const std::string& body);

  std::ostream& out_;
  bool announces_;  // interfaces; else the part before has done it
  std::vector<std::pair<std::string, pcapng::LinkType>> interfaces_;
};

}  // namespace ipos::tools
