#include "app/flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <limits>

#include "app/list_flags.h"
#include "base/error.h"
#include "base/nearest_word.h"
#include "base/parallel.h"

DEFINE_double(alpha, 0.03, "");
DEFINE_string(alpha_blocks, "velocity_attitude", "");
DEFINE_bool(allan, false, "");
DEFINE_string(ahrs_rule, "", "");
DEFINE_string(at, "", "");
DEFINE_bool(back_off, false, "");
DEFINE_string(bounded, "attitude=1rad", "");
DEFINE_bool(clean, false, "");
DEFINE_bool(collect, false, "");
DEFINE_string(constants, "", "");
DEFINE_string(data_root, "", "");
DEFINE_double(duration, 0.0, "");
DEFINE_double(delta, 0.0, "");
DEFINE_bool(dry_run, false, "");
DEFINE_string(engine, "local", "");
DEFINE_string(error, "navigation", "");
DEFINE_string(export, "", "");
DEFINE_bool(force, false, "");
DEFINE_double(from, -std::numeric_limits<double>::infinity(), "");
DEFINE_string(gamma, "20", "");
DEFINE_string(inject, "", "");
DEFINE_bool(json, false, "");
DEFINE_bool(list, false, "");
DEFINE_string(log, "none", "");
DEFINE_double(max_time, std::numeric_limits<double>::infinity(), "");
DEFINE_double(memory_limit, std::numeric_limits<double>::infinity(), "");
DEFINE_string(methods, "ekf,rts,iterated,batch", "");
DEFINE_string(metric, "trajectory", "");
DEFINE_bool(noise, false, "");
DEFINE_string(omit, "", "");
DEFINE_string(out, "", "");
DEFINE_string(point, "", "");
DEFINE_string(profile, "", "");
DEFINE_string(progress, "auto", "");
DEFINE_bool(quiet, false, "");
DEFINE_double(rate, 0.0, "");
DEFINE_string(faults, "", "");
DEFINE_bool(report, false, "");
DEFINE_bool(retry, false, "");
DEFINE_uint64(runs, 100, "");
DEFINE_string(sbatch, "", "");
DEFINE_uint64(seed, 1, "");
DEFINE_string(set, "", "");
DEFINE_string(shard, "", "");
DEFINE_string(sweep, "", "");
DEFINE_double(stale_after, 60.0, "");
DEFINE_uint64(threads, 0, "");
DEFINE_double(time_limit, std::numeric_limits<double>::infinity(), "");
DEFINE_double(to, std::numeric_limits<double>::infinity(), "");
DEFINE_string(withhold, "", "");
DEFINE_string(without, "", "");
DEFINE_uint64(workers, 0, "");
DEFINE_bool(write, false, "");
DEFINE_bool(yes, false, "");

namespace hindsight {
namespace {

const FlagUse* FindFlag(const Command& command, const std::string& name) {
  for (const auto* flags : {&command.flags, &CommonFlags()}) {
    for (const FlagUse& flag : *flags) {
      if (Dashed(flag.name) == name) return &flag;
    }
  }
  return nullptr;
}

[[noreturn]] void ThrowUnknownFlag(const Command& command,
                                   const std::string& name) {
  std::vector<std::string> known = {"--help"};
  for (const auto* flags : {&command.flags, &CommonFlags()}) {
    for (const FlagUse& flag : *flags) {
      known.push_back("--" + Dashed(flag.name));
    }
  }
  throw UsageError("unknown flag --" + name + " for '" + command.name + "'" +
                   Suggestion("--" + name, known));
}

std::string Refusal(const std::string& type, const std::string& value) {
  if (type == "bool") return "the value is not true or false";
  if (type == "double") {
    return IsOutOfRange(value) ? "the value is out of range"
                               : "the value is not a number";
  }
  const bool digits = value.find_first_not_of("0123456789") == value.npos;
  return digits && !value.empty()
             ? "the value is out of range"
             : "the value is not a whole number of 0 or more";
}

void SetFlag(const std::string& name, std::string value) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(name.c_str(), &info);
  const bool is_list = name == "withhold" || name == "inject" ||
                       name == "omit" || name == "set" || name == "sweep";
  if (is_list && !info.is_default) {
    value = info.current_value + ";" + value;
  }
  // gflags reads an unsigned value with strtoul, to which "-1" is a number.
  const bool bad_sign = info.type == "uint64" && value.starts_with("-");
  if (bad_sign ||
      gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty()) {
    throw UsageError("--" + Dashed(name) + "=" + value + ": " +
                     Refusal(info.type, value));
  }
}

/// Reads the flag in words[*i] and, if its value is the next word, moves *i on.
void ParseFlag(const Command& command, const std::vector<std::string>& words,
               std::size_t* i) {
  const std::string word =
      words[*i].substr(words[*i].starts_with("--") ? 2 : 1);
  const std::size_t equals = word.find('=');
  const std::string name = Dashed(word.substr(0, equals));
  const FlagUse* flag = FindFlag(command, name);
  const bool negated =
      flag == nullptr && name.starts_with("no") && equals == std::string::npos;
  if (negated) {
    flag = FindFlag(command, name.substr(2));
    if (flag != nullptr && !flag->placeholder.empty()) flag = nullptr;
  }
  if (flag == nullptr) ThrowUnknownFlag(command, name);
  if (equals != std::string::npos) {
    SetFlag(flag->name, word.substr(equals + 1));
  } else if (flag->placeholder.empty()) {
    SetFlag(flag->name, negated ? "false" : "true");
  } else if (*i + 1 < words.size() && !words[*i + 1].starts_with("--")) {
    SetFlag(flag->name, words[++*i]);
  } else {
    throw UsageError("--" + name + " needs a value: --" + name + "=" +
                     flag->placeholder);
  }
}

void CheckArgumentCount(const Command& command,
                        const std::vector<std::string>& positional) {
  const std::string usage =
      " (usage: hindsight " + command.name + " " + command.arguments + ")";
  if (positional.size() < command.min_arguments) {
    throw UsageError("'" + command.name + "' needs " +
                     std::to_string(command.min_arguments) + " argument" +
                     (command.min_arguments == 1 ? "" : "s") + usage);
  }
  if (positional.size() > command.max_arguments) {
    throw UsageError("unexpected argument '" +
                     positional[command.max_arguments] + "'" + usage);
  }
}

}  // namespace

const std::vector<FlagUse>& CommonFlags() {
  static const std::vector<FlagUse> flags = {
      {"log", "LEVEL", "log to stderr: info, warning, error or none (none)"},
      {"quiet", "",
       "nothing on stdout and no progress; the exit status tells"}};
  return flags;
}

ParsedArguments ParseArguments(const Command& command,
                               const std::vector<std::string>& words) {
  ParsedArguments parsed;
  bool flags_ended = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (flags_ended || word.size() < 2 || word[0] != '-') {
      parsed.positional.push_back(word);
    } else if (word == "--") {
      flags_ended = true;
    } else if (word == "--help" || word == "-h" || word == "-help") {
      parsed.help = true;
      return parsed;
    } else {
      ParseFlag(command, words, &i);
    }
  }
  CheckArgumentCount(command, parsed.positional);
  return parsed;
}

std::string Dashed(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

void GiveFlag(const std::string& name, const std::string& value) {
  SetFlag(name, value);
}

bool IsGiven(const std::string& name) {
  return !gflags::GetCommandLineFlagInfoOrDie(name.c_str()).is_default;
}

int ReadThreads() {
  constexpr std::uint64_t kMostThreads = 1024;
  if (FLAGS_threads > kMostThreads) {
    throw UsageError("--threads=" + std::to_string(FLAGS_threads) +
                     ": expected 0 to " + std::to_string(kMostThreads));
  }
  return FLAGS_threads > 0 ? static_cast<int>(FLAGS_threads) : ThreadCount();
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    std::string part = text.substr(begin, end - begin);
    part.erase(0, part.find_first_not_of(" \t"));
    part.erase(part.find_last_not_of(" \t") + 1);
    parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

std::string Joined(std::span<const std::string> parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (!part.empty()) text += (text.empty() ? "" : separator) + part;
  }
  return text;
}

std::string Suggestion(const std::string& word,
                       const std::vector<std::string>& candidates) {
  const std::string nearest = NearestWord(word, candidates);
  return nearest.empty() ? "" : ", did you mean " + nearest + "?";
}

}  // namespace hindsight
