#include <string>
#include <utility>

#include "io/config/config_help.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/config/noise_keys.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// The default of a key, as it would be written.
class Fallback {
 public:
  Fallback(const SensorKey& key, SensorSettings settings)
      : key_(key), settings_(std::move(settings)) {}

  std::string Text() {
    if (key_.needed != nullptr && key_.needed(settings_)) return "needed";
    return std::visit([this](const auto& value) { return this->Of(value); },
                      key_.value);
  }

 private:
  std::string Of(const SensorKey::Number& number) {
    const double value = *number.at(settings_);
    const bool none =
        number.range == SensorKey::Range::kPositive && value <= 0.0;
    return none ? "-" : DefaultText(value, key_.quantity);
  }
  std::string Of(const SensorKey::Vector& vector) {
    return DefaultText(*vector.at(settings_), key_.quantity);
  }
  static std::string Of(const SensorKey::OptionalNumber&) { return "-"; }
  static std::string Of(const SensorKey::OptionalSigmas&) { return "-"; }
  static std::string Of(const SensorKey::SidesSigma&) { return "-"; }
  static std::string Of(const SensorKey::Mounting&) { return "[0, 0, 0 deg]"; }
  static std::string Of(const SensorKey::Axes&) { return "[x, y, z]"; }
  static std::string Of(const SensorKey::Place&) { return "-"; }
  static std::string Of(const SensorKey::Whole&) { return "-"; }
  std::string Of(const SensorKey::Word& word) {
    return std::string(word.words[word.get(settings_)]);
  }

  const SensorKey& key_;
  SensorSettings settings_;
};

std::string Meaning(const SensorKey& key) {
  const auto* word = std::get_if<SensorKey::Word>(&key.value);
  if (word == nullptr) return std::string(key.help);
  return MeaningOf({word->words.begin(), word->words.end()}, key.help);
}

KeySection SectionOf(const SensorKind& kind) {
  KeySection section{
      "aiding: " + std::string(kind.name), std::string(kind.help) + ".", {}};
  std::string columns;
  for (const FieldName& column : kind.columns) {
    if (kind.generated) break;
    columns +=
        (columns.empty() ? " Columns " : ", ") + std::string(column.name);
  }
  if (kind.generated) columns = " It has no file";
  section.about += columns + ".";
  section.about[0] = static_cast<char>(std::toupper(section.about[0]));
  for (const SensorKey& key : kind.keys) {
    if (key.simulated) continue;
    section.keys.push_back({std::string(key.name), Meaning(key),
                            Fallback(key, SettingsOf(kind)).Text(),
                            std::string(key.when)});
  }
  if (kind.has_clock) {
    section.keys.push_back(
        {"estimate.time_offset", "a priori sigma of an estimated one", "-"});
  }
  return section;
}

}  // namespace

std::vector<KeySection> ConfigSections() {
  std::vector<KeySection> sections = {RecordingSection()};
  for (const auto& more : {StreamSections(), ImuSections(), StartSections()}) {
    sections.insert(sections.end(), more.begin(), more.end());
  }
  sections.push_back(ConstantsSection());
  sections.push_back(AhrsSection());
  sections.push_back(AidingSection());
  sections.push_back(NoiseSection());
  for (const SensorKind* kind : SensorKinds()) {
    if (kind->configured) sections.push_back(SectionOf(*kind));
  }
  return sections;
}

}  // namespace hindsight
