#ifndef HINDSIGHT_IO_WRITE_HTML_H_
#define HINDSIGHT_IO_WRITE_HTML_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hindsight {

/// Text between tags or within a quoted attribute: & < > " ' as entities, and
/// other control characters than tab and line feed as U+FFFD.
std::string EscapeHtml(std::string_view text);

/// JSON within <script type="application/json">: no '<' is left in it, so that
/// no name can end the element or open a comment. Bytes that are no UTF-8 come
/// as U+FFFD.
std::string ScriptJson(const nlohmann::ordered_json& json);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_HTML_H_
