#ifndef HINDSIGHT_BASE_NEAREST_WORD_H_
#define HINDSIGHT_BASE_NEAREST_WORD_H_

#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// The candidate nearest to `word` by edit distance, or "" if none is near.
std::string NearestWord(std::string_view word,
                        const std::vector<std::string>& candidates);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_NEAREST_WORD_H_
