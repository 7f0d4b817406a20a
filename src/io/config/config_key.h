#ifndef HINDSIGHT_IO_CONFIG_CONFIG_KEY_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_KEY_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "earth/wgs84.h"
#include "io/config/config_help.h"
#include "io/config/config_map.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

/// What a number may be.
using KeyRange = SensorKey::Range;

bool LiesIn(KeyRange range, double value);

/// The number under `name`. Throws InputError for one outside the range.
double ReadInRange(ConfigMap* map, const std::string& name, Quantity quantity,
                   KeyRange range);

/// A vector of lengths is where something sits on a vehicle, from its IMU. Throws
/// InputError for one longer than 1 km, which no vehicle is.
void RequireOnBoard(const ConfigMap& map, const std::string& name,
                    Quantity quantity, const Eigen::Vector3d& value);

/// latitude, longitude, height under `key`; nothing if it is absent.
std::optional<Geodetic> ReadGeodetic(ConfigMap* map, const std::string& key);

/// One key of a map that fills a T: how it is written, where its value goes,
/// and what is said of it. The default is what stands in a new T.
template <class T>
struct ConfigKey {
  struct Number {
    double T::*at;
    KeyRange range = KeyRange::kAny;
  };
  /// Absent is a value of its own.
  struct OptionalNumber {
    std::optional<double> T::*at;
    KeyRange range = KeyRange::kAny;
  };
  /// Three values.
  struct Vector {
    Eigen::Vector3d T::*at;
  };
  struct OptionalVector {
    std::optional<Eigen::Vector3d> T::*at;
  };
  /// Three standard deviations that may be zero, or one for all.
  struct Spread {
    Eigen::Vector3d T::*at;
  };
  /// Three standard deviations greater than zero, or one for all.
  struct OptionalSigma {
    std::optional<Eigen::Vector3d> T::*at;
  };
  struct Place {
    std::optional<Geodetic> T::*at;
  };
  struct Text {
    std::string T::*at;
  };
  struct Flag {
    bool T::*at;
  };
  struct Word {
    std::vector<std::string> words;
    std::size_t (*get)(const T&);
    void (*set)(T&, std::size_t);
  };
  /// What none of these says; nullptr: is read with the key before.
  struct Special {
    void (*read)(ConfigMap*, T*) = nullptr;
  };
  using Value =
      std::variant<Number, OptionalNumber, Vector, OptionalVector, Spread,
                   OptionalSigma, Place, Text, Flag, Word, Special>;

  std::string_view name;
  Quantity quantity = Quantity::kRatio;
  Value value;
  std::string_view help = {};
  bool needed = false;  ///< what is Special says so itself
  /// The default in words, where it is not what stands in a new T.
  std::string_view fallback = {};
};

/// The keys of one map, in the order in which they are read.
template <class T>
struct ConfigTable {
  std::string_view name;  ///< KeySection::name
  std::string_view about;
  std::vector<ConfigKey<T>> keys;
};

/// Reads one key into a T.
template <class T>
class KeyReader {
 public:
  using Key = ConfigKey<T>;
  KeyReader(const Key& key, ConfigMap* map, T* out)
      : key_(key), name_(key.name), map_(*map), out_(*out) {}

  void Read() {
    std::visit([this](const auto& value) { this->Take(value); }, key_.value);
  }

 private:
  void Take(const typename Key::Number& number) {
    double& value = out_.*number.at;
    if (key_.needed || map_.Has(name_)) {
      value = ReadInRange(&map_, name_, key_.quantity, number.range);
    } else {
      map_.Resolve(name_, value, key_.quantity);
    }
  }
  void Take(const typename Key::OptionalNumber& number) {
    if (!map_.Has(name_)) return;
    out_.*number.at = ReadInRange(&map_, name_, key_.quantity, number.range);
  }
  void Take(const typename Key::Vector& vector) {
    out_.*vector.at = map_.Vector(name_, key_.quantity, out_.*vector.at);
    RequireOnBoard(map_, name_, key_.quantity, out_.*vector.at);
  }
  void Take(const typename Key::OptionalVector& vector) {
    out_.*vector.at = map_.OptionalVector(name_, key_.quantity);
  }
  void Take(const typename Key::Spread& spread) {
    Eigen::Vector3d& sigma = out_.*spread.at;
    sigma = map_.OptionalVector(name_, key_.quantity, true).value_or(sigma);
    if (sigma.minCoeff() < 0.0) map_.Fail(name_, "must not be negative");
  }
  void Take(const typename Key::OptionalSigma& sigma) {
    out_.*sigma.at = map_.OptionalSigma(name_, key_.quantity);
  }
  void Take(const typename Key::Place& place) {
    out_.*place.at = ReadGeodetic(&map_, name_);
  }
  void Take(const typename Key::Text& text) {
    out_.*text.at = map_.Text(name_);
  }
  void Take(const typename Key::Flag& flag) {
    out_.*flag.at = map_.Flag(name_, out_.*flag.at);
  }
  void Take(const typename Key::Word& word) {
    word.set(out_, map_.Choice(name_, word.words, word.get(out_)));
  }
  void Take(const typename Key::Special& special) {
    if (special.read != nullptr) special.read(&map_, &out_);
  }

  const Key& key_;
  const std::string name_;
  ConfigMap& map_;
  T& out_;
};

/// Reads all keys of the table, but does not say that there are no others.
template <class T>
void ReadTable(const ConfigTable<T>& table, ConfigMap* map, T* out) {
  for (const ConfigKey<T>& key : table.keys) KeyReader(key, map, out).Read();
}

/// "0.5 s", and "[0, 0, 0 m]".
std::string DefaultText(double value, Quantity quantity);
std::string DefaultText(const Eigen::Vector3d& value, Quantity quantity);

/// The default of a key as it would be written.
template <class T>
std::string DefaultText(const ConfigKey<T>& key) {
  using Key = ConfigKey<T>;
  if (key.needed) return "needed";
  if (!key.fallback.empty()) return std::string(key.fallback);
  const T fresh{};
  if (const auto* number = std::get_if<typename Key::Number>(&key.value)) {
    return DefaultText(fresh.*number->at, key.quantity);
  }
  if (const auto* vector = std::get_if<typename Key::Vector>(&key.value)) {
    return DefaultText(fresh.*vector->at, key.quantity);
  }
  if (const auto* spread = std::get_if<typename Key::Spread>(&key.value)) {
    return DefaultText(fresh.*spread->at, key.quantity);
  }
  if (const auto* flag = std::get_if<typename Key::Flag>(&key.value)) {
    return fresh.*flag->at ? "true" : "false";
  }
  if (const auto* word = std::get_if<typename Key::Word>(&key.value)) {
    return word->words[word->get(fresh)];
  }
  return "-";
}

/// The words that a key may have, before what it means.
std::string MeaningOf(const std::vector<std::string>& words,
                      std::string_view help);

/// The table as help and documentation show it.
template <class T>
KeySection Documented(const ConfigTable<T>& table) {
  KeySection section = {std::string(table.name), std::string(table.about), {}};
  for (const ConfigKey<T>& key : table.keys) {
    const auto* word = std::get_if<typename ConfigKey<T>::Word>(&key.value);
    section.keys.push_back(
        {std::string(key.name),
         MeaningOf(word == nullptr ? std::vector<std::string>() : word->words,
                   key.help),
         DefaultText(key)});
  }
  return section;
}

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_KEY_H_
