#include "app/campaign_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "app/report_html.h"
#include "app/report_page.h"
#include "io/read/paths.h"
#include "io/write/csv_line.h"
#include "io/write/html.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

/// What becomes of an item, the worst first.
constexpr std::array<const char*, 5> kStandings = {
    "failed", "open", "not usable", "doubtful", "usable"};

std::string StateWord(const CampaignRow& row) {
  if (!row.record) return "open";
  return row.record->done ? "done" : "failed";
}

std::size_t StandingOf(const CampaignRow& row) {
  const std::string state = StateWord(row);
  const std::string word = state == "done" ? row.record->grade : state;
  const auto* found = std::find(kStandings.begin(), kStandings.end(), word);
  return static_cast<std::size_t>(found - kStandings.begin());
}

std::string NumberText(const std::optional<double>& value, int digits) {
  return value ? FormatGeneral(*value, digits) : "";
}

/// From the campaign's folder; "" where there is none.
std::string ReportOf(const CampaignItem& item, const fs::path& folder) {
  const fs::path report = ItemPlace(folder, item).results / kReportName;
  return IsFile(report) ? report.lexically_relative(folder).string() : "";
}

/// Letters of a path within an address.
std::string Address(const std::string& path) {
  std::string address;
  for (const char letter : path) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_plain =
        std::isalnum(byte) != 0 ||
        std::string_view("/-_.~").find(letter) != std::string_view::npos;
    address += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return address;
}

}  // namespace

std::vector<CampaignRow> ReadCampaign(const std::vector<CampaignItem>& items,
                                      const fs::path& folder) {
  std::vector<CampaignRow> rows;
  for (const CampaignItem& item : items) {
    rows.push_back({item, RecordOf(item, ItemPlace(folder, item)),
                    ReportOf(item, folder)});
  }
  const auto rank = [](const CampaignRow& row) {
    const ItemRecord none;
    const ItemRecord& record = row.record ? *row.record : none;
    const double nis = record.nis.value_or(1.0);
    return std::tuple(StandingOf(row), -record.withheld_rms.value_or(-1.0),
                      nis > 0.0 ? -std::abs(std::log(nis))
                                : -std::numeric_limits<double>::infinity(),
                      row.item.name);
  };
  std::sort(rows.begin(), rows.end(),
            [&](const CampaignRow& a, const CampaignRow& b) {
              return rank(a) < rank(b);
            });
  return rows;
}

std::string CampaignCsv(const std::vector<CampaignRow>& rows) {
  std::string text =
      CsvLine({"name", "state", "grade", "best", "withheld_rms[m]", "nis",
               "unobserved", "reason", "config", "report", "seconds", "mb"});
  for (const CampaignRow& row : rows) {
    const ItemRecord record = row.record.value_or(ItemRecord());
    text += CsvLine(
        {row.item.name, StateWord(row), record.grade, record.best,
         NumberText(record.withheld_rms, 6), NumberText(record.nis, 6),
         record.unobserved, record.reason, row.item.config.string(), row.report,
         NumberText(record.seconds, 4), NumberText(record.megabytes, 4)});
  }
  return text;
}

std::string CampaignPage(const std::vector<CampaignRow>& rows,
                         const fs::path& folder) {
  HtmlTable table({"item", "state", "grade", "best method", "withheld RMS [m]",
                   "NIS", "unobserved", "seconds", "MB", "why"});
  for (const CampaignRow& row : rows) {
    const ItemRecord record = row.record.value_or(ItemRecord());
    const fs::path log =
        ItemPlace(folder, row.item).log.lexically_relative(folder);
    table.AddRow({row.item.name, StateWord(row), record.grade, record.best,
                  NumberText(record.withheld_rms, 3), NumberText(record.nis, 3),
                  record.unobserved, NumberText(record.seconds, 3),
                  NumberText(record.megabytes, 3), record.reason},
                 Address(row.report.empty() ? log.string() : row.report));
  }
  return StaticPage(folder.filename().string(),
                    "<section><p>" + EscapeHtml(CampaignCounts(rows)) +
                        " Worst first; a name leads to the item's report, or "
                        "to its log.</p>\n" +
                        table.Render() + "</section>\n");
}

std::string CampaignCounts(const std::vector<CampaignRow>& rows) {
  std::array<std::size_t, kStandings.size()> counts = {};
  for (const CampaignRow& row : rows) ++counts.at(StandingOf(row));
  std::string text =
      fmt::format("{} item{}", rows.size(), rows.size() == 1 ? "" : "s");
  for (std::size_t i = kStandings.size(); i-- > 0;) {
    if (counts[i] == 0) continue;
    text += fmt::format("{} {} {}", text.find(':') == text.npos ? ":" : ",",
                        counts[i], kStandings[i]);
  }
  return text + ".";
}

std::string CampaignText(const std::vector<CampaignRow>& rows) {
  constexpr std::size_t kMost = 10;
  std::string text;
  std::size_t failed = 0;
  for (const CampaignRow& row : rows) {
    if (StateWord(row) != "failed" || ++failed > kMost) continue;
    text += "failed: " + row.item.name + ": " + row.record->reason + "\n";
  }
  if (failed > kMost) text += fmt::format("and {} more\n", failed - kMost);
  return text + CampaignCounts(rows) + "\n";
}

}  // namespace hindsight
