// The frames of a CANopen line in words: "585 SDO 1800h:2 TPDO1 transmission type = 1 <- node 5". It listens to the
// line from its beginning: a mapping that a master writes is known from then on, and a segment belongs to its object.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/mapping.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/sdo.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime::canopen {

struct NodeName {
  uint8_t node = 0;
  std::string name;
  const stdlib::UnitType* unit = nullptr;  // whose parameters it has; MOVIDRIVE MDX60B/61B when not known
  WordAssignment output{};                 // P870..P872
  WordAssignment input{};                  // P873..P875
  std::shared_ptr<const ObjectDictionary>
      dictionary{};  // as it is when the name is looked up; null: the defaults
};

// "EMCY FF00h fault, error register 81h, status word 1 2B22h"
std::string emergency_text(const Frame& frame);

class LineWords {
 public:
  explicit LineWords(std::vector<NodeName> names = {});

  // What a node is called from now on; what was heard of it stays.
  void name(NodeName name);

  // Of the next frame on the line.
  Description describe(const Frame& frame);
  // The same for a frame whose words nobody wants.
  void listen(const Frame& frame);

 private:
  // What is known of a node: its name, its objects as they were written, and the SDO transfer under way.
  struct Listened {
    NodeName name;
    ObjectDictionary dictionary;
    std::optional<Address> transfer;
    std::optional<uint32_t> written;  // by the request before, not confirmed yet
  };
  struct Pdo {
    uint8_t node;
    bool transmit;
    uint8_t number;  // from 0
  };
  Listened& node(uint8_t number);

  std::optional<std::string> pdo_text(const Frame& frame);
  std::string addressed_text(const Frame& frame, const Addressed& addressed);
  std::string nmt_text(const Frame& frame);
  std::string sdo_request_text(Listened& node, const SdoBytes& bytes);
  std::string sdo_response_text(Listened& node, const SdoBytes& bytes);

  void find_messages();  // objects have changed

  std::map<uint8_t, Listened> nodes_;
  std::map<uint32_t, Pdo> pdos_;  // those that are on, by identifier
  std::set<uint32_t> syncs_;      // identifiers of SYNC
};

}  // namespace ipos::runtime::canopen
