#ifndef HINDSIGHT_APP_ABANDONED_H_
#define HINDSIGHT_APP_ABANDONED_H_

#include <filesystem>
#include <functional>
#include <string>

namespace hindsight {

/// Why something that lies at `path` is not what this program left there, in
/// words that follow its name; "" if it is.
using Disowned = std::function<std::string(const std::filesystem::path& path)>;

/// Of a folder of results that was being written: that it is one and holds
/// nothing but files of its manifest, finished or not.
std::string DisownedFolder(const std::filesystem::path& path);

/// Names on standard error what killed runs left beside `target`, or removes it
/// with `clean`. Complete results are only named. Throws InputError if `clean`
/// meets something under such a name that is `disowned`, or that cannot be
/// removed; it is left as it is.
void TreatAbandoned(const std::filesystem::path& target, bool clean,
                    const Disowned& disowned);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_ABANDONED_H_
