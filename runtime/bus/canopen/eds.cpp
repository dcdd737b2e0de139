// Sections of an EDS, each from the rows of objects.def or of the parameter list.
#include "runtime/bus/canopen/eds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "runtime/bus/canopen/object_dictionary.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime::canopen {
namespace {


std::string_view access_text(Access access) {
  switch (access) {
    case Access::Constant: return "const";
    case Access::ReadWrite: return "rw";
    case Access::Receive: return "rww";
    case Access::ReadOnly:
    case Access::Transmit:
    case Access::Dummy: break;
  }
  return "ro";
}

void write_head(std::string& out, std::string_view section, std::string_view name, ObjectKind kind) {
  out += fmt::format("[{}]\nParameterName={}\nObjectType=0x{:X}\n", section, name,
                 static_cast<unsigned>(kind));
}

void write_entry(std::string& out, std::string_view section, const EntryRow& row, Address address) {
  write_head(out, section, entry_name(address), ObjectKind::Variable);
  out += fmt::format("DataType=0x{:04X}\nAccessType={}\n", static_cast<unsigned>(row.type),
                 access_text(row.access));
  const uint32_t value = row.default_of(address.sub);
  if (row.type == DataType::VisibleString)
    out += "DefaultValue=\n";
  else if (row.own)
    out += fmt::format("DefaultValue=$NODEID+0x{:X}\n", value);
  else
    out += fmt::format("DefaultValue=0x{:X}\n", value);
  if (row.rule == Rule::MappingCount) out += fmt::format("HighLimit=0x{:X}\n", objects::kMappedObjects);
  const bool mapped = row.access == Access::Receive || row.access == Access::Transmit;
  out += fmt::format("PDOMapping={}\n\n", mapped ? 1 : 0);
}

void write_object(std::string& out, const ObjectDictionary& dictionary, const ObjectRow& object) {
  const std::string section = fmt::format("{:04X}", object.index);
  std::vector<const ObjectDictionary::Entry*> subs;
  for (const ObjectDictionary::Entry& entry : dictionary.entries())
    if (entry.address.index == object.index) subs.push_back(&entry);
  if (object.kind == ObjectKind::Variable) return write_entry(out, section, *subs[0]->row, subs[0]->address);
  write_head(out, section, object.name, object.kind);
  out += fmt::format("SubNumber={}\n\n", subs.size());
  for (const ObjectDictionary::Entry* sub : subs)
    write_entry(out, fmt::format("{}sub{:X}", section, sub->address.sub), *sub->row, sub->address);
}

// Sub-index 0, four bytes (page 55 of 11264926).
void write_parameter(std::string& out, const stdlib::Parameter& parameter) {
  const bool is_unsigned = parameter.is_unsigned();
  write_head(out, fmt::format("{:04X}", parameter.index),
             fmt::format("{}{}{}{}", parameter.number.empty() ? "" : "P", parameter.number,
                         parameter.number.empty() ? "" : " ", parameter.name),
             ObjectKind::Variable);
  out += fmt::format("DataType=0x{:04X}\nAccessType={}\nDefaultValue={}\n",
                 static_cast<unsigned>(is_unsigned ? DataType::Unsigned32 : DataType::Integer32),
                 parameter.writable ? "rw" : "ro", parameter.default_value);
  if (parameter.writable && !(parameter.ranges.empty() && parameter.texts.empty()))
    out += fmt::format("LowLimit={}\nHighLimit={}\n", parameter.minimum(), parameter.maximum());
  out += "PDOMapping=0\n\n";
}

void write_list(std::string& out, std::string_view section, const std::vector<uint16_t>& indices) {
  out += fmt::format("[{}]\nSupportedObjects={}\n", section, indices.size());
  for (size_t n = 0; n < indices.size(); ++n) out += fmt::format("{}=0x{:04X}\n", n + 1, indices[n]);
  out += "\n";
}

constexpr bool is_mandatory(uint16_t index) { return index == 0x1000 || index == 0x1001 || index == 0x1018; }
constexpr uint16_t kFirstOfUnit = 0x2000;

void write_device(std::string& out, const stdlib::UnitType& unit) {
  // The dates are those of the tables: the text is the same whenever it is written.
  out += fmt::format("[FileInfo]\nFileName={0}.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n"
                 "Description=Simulated {1}\nCreationTime=12:00AM\nCreationDate=01-01-2026\nCreatedBy=ipos\n"
                 "ModificationTime=12:00AM\nModificationDate=01-01-2026\nModifiedBy=ipos\n\n"
                 "[DeviceInfo]\nVendorName=ipos\nVendorNumber=0x0\nProductName={1}\nProductNumber=0x0\n"
                 "RevisionNumber=0x10000\nOrderCode={0}\nBaudRate_10=0\nBaudRate_20=0\nBaudRate_50=0\n"
                 "BaudRate_125=1\nBaudRate_250=1\nBaudRate_500=1\nBaudRate_800=0\nBaudRate_1000=1\n"
                 "SimpleBootUpMaster=0\nSimpleBootUpSlave=1\nGranularity=8\nDynamicChannelsSupported=0\n"
                 "GroupMessaging=0\nNrOfRXPDO={2}\nNrOfTXPDO={2}\nLSS_Supported=0\n\n",
                 unit.name, unit.title, objects::kPdos);
  out += "[DummyUsage]\n";
  for (unsigned type = 1; type <= 7; ++type) {
    const auto rows = entry_rows();
    const bool used = std::any_of(rows.begin(), rows.end(), [&](const EntryRow& row) {
      return row.access == Access::Dummy && row.index == type;
    });
    out += fmt::format("Dummy{:04X}={}\n", type, used ? 1 : 0);
  }
  out += "\n[Comments]\nLines=0\n\n";
}

}  // namespace

std::string eds_text(const stdlib::UnitType& unit) {
  std::string out;
  write_device(out, unit);
  std::vector<uint16_t> mandatory, optional, manufacturer;
  for (const ObjectRow& object : object_rows())
    (is_mandatory(object.index)    ? mandatory
     : object.index < kFirstOfUnit ? optional
                                   : manufacturer)
        .push_back(object.index);
  std::sort(optional.begin(), optional.end());
  const auto parameters = stdlib::parameter_table(unit).by_index();
  for (const stdlib::Parameter* parameter : parameters)
    if (parameter->index >= kFirstOfUnit) manufacturer.push_back(parameter->index);
  write_list(out, "MandatoryObjects", mandatory);
  write_list(out, "OptionalObjects", optional);
  write_list(out, "ManufacturerObjects", manufacturer);

  const ObjectDictionary dictionary(0);
  for (const std::vector<uint16_t>* list : {&mandatory, &optional})
    for (const uint16_t index : *list) write_object(out, dictionary, *find_object(index));
  for (const uint16_t index : manufacturer)
    if (const ObjectRow* object = find_object(index)) write_object(out, dictionary, *object);
  for (const stdlib::Parameter* parameter : parameters)
    if (parameter->index >= kFirstOfUnit) write_parameter(out, *parameter);
  return out;
}

}  // namespace ipos::runtime::canopen
