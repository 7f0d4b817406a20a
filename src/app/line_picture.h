#ifndef HINDSIGHT_APP_LINE_PICTURE_H_
#define HINDSIGHT_APP_LINE_PICTURE_H_

#include <string>
#include <vector>

namespace hindsight {

/// Lines over a common axis as a picture (SVG) of a page, with a legend. Points
/// that are not finite, or on a logarithmic axis not positive, interrupt them.
/// Bars do not widen the axes; a line without a point is left out.
struct LinePicture {
  struct Line {
    std::string label;
    std::vector<double> x;
    std::vector<double> y;
    /// Ends of a bar at each point; empty: none.
    std::vector<double> low = {};
    std::vector<double> high = {};
    bool dashed = false;
  };
  std::string title;
  std::string axis;  ///< what x is, with its unit
  std::vector<Line> lines;
  std::vector<double> levels = {};  ///< dashed, horizontal
  bool logarithmic = false;         ///< y
  bool logarithmic_x = false;
};

/// "" if there is nothing to draw.
std::string Render(const LinePicture& picture);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_LINE_PICTURE_H_
