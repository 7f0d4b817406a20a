#include "app/line_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/write/html.h"

namespace hindsight {
namespace {

constexpr double kWidth = 480.0;
constexpr double kHeight = 200.0;
constexpr double kLeft = 56.0;
constexpr double kTop = 8.0;
constexpr double kBottom = 34.0;  // below the axis
constexpr int kColours = 8;       // of the page's palette
constexpr std::size_t kMostPoints = 600;

/// A range of values and where on the picture it lies.
class PictureAxis {
 public:
  PictureAxis(double from, double to, bool logarithmic)
      : from_(from), to_(to), logarithmic_(logarithmic) {}

  void Add(double value) {
    if (!Shows(value)) return;
    low_ = std::min(low_, Scaled(value));
    high_ = std::max(high_, Scaled(value));
  }
  bool empty() const { return low_ > high_; }
  bool Shows(double value) const {
    return std::isfinite(value) && (!logarithmic_ || value > 0.0);
  }
  double At(double value) const {
    const double span = high_ - low_;
    const double share = span > 0.0 ? (Scaled(value) - low_) / span : 0.5;
    return from_ + share * (to_ - from_);
  }
  /// Three values over the range.
  std::vector<double> Ticks() const {
    std::vector<double> ticks;
    for (const double share : {0.0, 0.5, 1.0}) {
      const double scaled = low_ + share * (high_ - low_);
      ticks.push_back(logarithmic_ ? std::pow(10.0, scaled) : scaled);
      if (high_ == low_) break;
    }
    return ticks;
  }

 private:
  double Scaled(double value) const {
    return logarithmic_ ? std::log10(value) : value;
  }

  double from_;
  double to_;
  bool logarithmic_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

std::string LinePath(const LinePicture::Line& line, const PictureAxis& x,
                     const PictureAxis& y) {
  const std::size_t stride = line.x.size() / kMostPoints + 1;
  std::string path;
  bool is_down = false;
  for (std::size_t i = 0; i < line.x.size(); i += stride) {
    if (!x.Shows(line.x[i]) || !y.Shows(line.y[i])) {
      is_down = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", is_down ? "L" : "M", x.At(line.x[i]),
                        y.At(line.y[i]));
    is_down = true;
  }
  return path;
}

/// The bars of a line, kept to the height of the picture.
std::string BarPath(const LinePicture::Line& line, const PictureAxis& x,
                    const PictureAxis& y) {
  std::string path;
  for (std::size_t i = 0; i < line.low.size(); ++i) {
    if (!x.Shows(line.x[i]) || !y.Shows(line.low[i]) ||
        !y.Shows(line.high[i])) {
      continue;
    }
    const auto inside = [&](double value) {
      return std::clamp(y.At(value), kTop, kTop + kHeight);
    };
    path += fmt::format("M{:.1f} {:.1f}V{:.1f}", x.At(line.x[i]),
                        inside(line.low[i]), inside(line.high[i]));
  }
  return path;
}

std::string TextAt(double x, double y, const char* anchor,
                   const std::string& text) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y,
      anchor, EscapeHtml(text));
}

}  // namespace

std::string Render(const LinePicture& picture) {
  PictureAxis x(kLeft, kWidth - 8.0, picture.logarithmic_x);
  PictureAxis y(kTop + kHeight, kTop, picture.logarithmic);
  for (const LinePicture::Line& line : picture.lines) {
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      if (!x.Shows(line.x[i]) || !y.Shows(line.y[i])) continue;
      x.Add(line.x[i]);
      y.Add(line.y[i]);
    }
  }
  if (y.empty()) return "";
  for (const double level : picture.levels) y.Add(level);
  std::string html = fmt::format(
      "<figure class=\"bars\"><figcaption><b>{0}</b></figcaption><svg "
      "viewBox=\"0 0 {1} {2}\" role=\"img\" aria-label=\"{0}\">",
      EscapeHtml(picture.title), kWidth, kTop + kHeight + kBottom);
  html += fmt::format("<path d=\"M{0} {1}V{2}H{3}\"/>", kLeft, kTop,
                      kTop + kHeight, kWidth);
  for (const double tick : y.Ticks()) {
    html += TextAt(kLeft - 4.0, y.At(tick) + 4.0, "end",
                   fmt::format("{:.3g}", tick));
  }
  const std::vector<double> ticks = x.Ticks();
  for (const double tick : ticks) {
    const char* anchor = ticks.size() > 1 && tick == ticks.front()  ? "start"
                         : ticks.size() > 1 && tick == ticks.back() ? "end"
                                                                    : "middle";
    html += TextAt(x.At(tick), kTop + kHeight + 14.0, anchor,
                   fmt::format("{:.4g}", tick));
  }
  html += TextAt(kLeft + (kWidth - kLeft) / 2.0, kTop + kHeight + 29.0,
                 "middle", picture.axis);
  for (const double level : picture.levels) {
    if (!y.Shows(level)) continue;
    html += fmt::format("<path class=\"level\" d=\"M{} {:.1f}H{}\"/>", kLeft,
                        y.At(level), kWidth);
  }
  std::string legend;
  for (std::size_t i = 0; i < picture.lines.size(); ++i) {
    const std::string style =
        fmt::format("var(--c{})", i % static_cast<std::size_t>(kColours));
    const std::string path = LinePath(picture.lines[i], x, y);
    if (path.empty()) continue;
    html += fmt::format(
        "<path style=\"stroke: {}; stroke-width: {}\" d=\"{}\"/>", style,
        picture.lines[i].dashed ? "1.5; stroke-dasharray: 5 4" : "2",
        path + BarPath(picture.lines[i], x, y));
    legend += fmt::format("<strong style=\"color: {}\">{}</strong> ", style,
                          EscapeHtml(picture.lines[i].label));
  }
  return html + "</svg><p>" + legend + "</p></figure>\n";
}

}  // namespace hindsight
