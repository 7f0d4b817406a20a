#ifndef HINDSIGHT_APP_FLAGS_H_
#define HINDSIGHT_APP_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <span>
#include <string>
#include <vector>

#include "app/command.h"

DECLARE_double(alpha);
DECLARE_string(alpha_blocks);
DECLARE_bool(allan);
DECLARE_string(ahrs_rule);
DECLARE_string(at);
DECLARE_bool(back_off);
DECLARE_string(bounded);
DECLARE_bool(clean);
DECLARE_bool(collect);
DECLARE_string(constants);
DECLARE_string(data_root);
DECLARE_double(duration);
DECLARE_double(delta);
DECLARE_bool(dry_run);
DECLARE_string(engine);
DECLARE_string(error);
DECLARE_string(export);
DECLARE_bool(force);
DECLARE_double(from);
DECLARE_string(gamma);
DECLARE_string(inject);
DECLARE_bool(json);
DECLARE_bool(list);
DECLARE_string(log);
DECLARE_double(max_time);
DECLARE_double(memory_limit);
DECLARE_string(methods);
DECLARE_string(metric);
DECLARE_bool(noise);
DECLARE_string(omit);
DECLARE_string(out);
DECLARE_string(faults);
DECLARE_string(point);
DECLARE_string(profile);
DECLARE_string(progress);
DECLARE_bool(quiet);
DECLARE_double(rate);
DECLARE_bool(report);
DECLARE_bool(retry);
DECLARE_uint64(runs);
DECLARE_string(sbatch);
DECLARE_uint64(seed);
DECLARE_string(set);
DECLARE_string(shard);
DECLARE_string(sweep);
DECLARE_double(stale_after);
DECLARE_uint64(threads);
DECLARE_double(time_limit);
DECLARE_double(to);
DECLARE_string(withhold);
DECLARE_string(without);
DECLARE_uint64(workers);
DECLARE_bool(write);
DECLARE_bool(yes);

namespace hindsight {

/// What the words after the sub-command's name say.
struct ParsedArguments {
  std::vector<std::string> positional;
  bool help = false;  ///< --help or -h was among them
};

/// Sets the gflags of `command` from `words`. A value follows "=" or is the
/// next word; flags and positional arguments may be mixed; "--" ends the
/// flags. Values of a repeated --withhold, --inject, --omit, --set or --sweep
/// are joined with ";".
/// Throws UsageError for a flag the command does not accept, a bad value, and a
/// wrong number of positional arguments.
ParsedArguments ParseArguments(const Command& command,
                               const std::vector<std::string>& words);

/// "alpha-blocks" of "alpha_blocks": a flag as it is written.
std::string Dashed(std::string name);

/// Gives a flag a value as the command line would. Throws UsageError.
void GiveFlag(const std::string& name, const std::string& value);

/// True if the flag `name` was on the command line.
bool IsGiven(const std::string& name);

/// What --threads asks for; 0 as many as the process has cores. Throws
/// UsageError for more than 1024.
int ReadThreads();

/// Flags that every sub-command accepts.
const std::vector<FlagUse>& CommonFlags();

/// The parts of `text` between `separator`s, blanks trimmed, empty parts kept;
/// nothing for an empty text.
std::vector<std::string> Split(const std::string& text, char separator);

/// The parts that are not empty with `separator` between them.
std::string Joined(std::span<const std::string> parts, const char* separator);

/// ", did you mean NAME?" for the candidate nearest to `word`, or "" if none
/// is near.
std::string Suggestion(const std::string& word,
                       const std::vector<std::string>& candidates);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_FLAGS_H_
