#include "apps/report/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/report/html.h"

namespace volgi::app {
namespace {

// Okabe and Ito 2008: told apart by every kind of colour vision. The page's script has the same.
constexpr std::array kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                             "#56b4e9", "#8b6f47", "#7f7f7f", "#882255", "#44aa99"};

constexpr double kLeft = 58, kRight = 12, kTop = 12, kBottom = 44, kWidth = 720, kHeight = 400, kLegendRow = 18;

struct Axis {
  double low, high, from, to;  // of log10, and where they lie
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

double shown_error(const Judged& j) { return std::max(j.error_percent, 0.01); }

Axis axis(double smallest, double largest, double from, double to) {
  const double room = 0.06;
  return {std::log10(smallest) - room, std::log10(largest) + room, from, to};
}

// 1, 2 and 5 of every decade in view.
std::vector<double> ticks(const Axis& axis) {
  std::vector<double> out;
  for (int decade = int(std::floor(axis.low)); decade <= int(std::ceil(axis.high)); ++decade)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, decade);
      if (std::log10(value) >= axis.low && std::log10(value) <= axis.high) out.push_back(value);
    }
  return out;
}

std::string axes(const Axis& x, const Axis& y) {
  std::string out;
  for (const double t : ticks(x)) {
    out += fmt::format(
        "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}"
        "</text>",
        x.at(t), y.to, y.from, y.from + 16, t);
  }
  for (const double t : ticks(y)) {
    out += fmt::format(
        "<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}"
        "</text>",
        y.at(t), x.from, x.to, x.from - 6, y.at(t) + 4, t);
  }
  return out + fmt::format(
                   "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">time per frame [ms]</text>"
                   "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">error [%]</text>",
                   (x.from + x.to) / 2, y.from + 34, (y.from + y.to) / 2);
}

// Down in steps: until a better point's time, the error is that of the last one.
std::string front_path(const Verdict& v, const Axis& x, const Axis& y) {
  std::string path;
  for (const size_t i : v.front) {
    const Judged& j = v.judged[i];
    path += path.empty() ? fmt::format("M{:.1f} {:.1f}", x.at(j.time_ms), y.at(shown_error(j)))
                         : fmt::format("H{:.1f}V{:.1f}", x.at(j.time_ms), y.at(shown_error(j)));
  }
  return "<path class=\"front\" d=\"" + path + "\"/>";
}

std::string techniques_points(const Verdict& v, const Axis& x, const Axis& y) {
  std::vector<std::string> techniques;
  for (const Judged& j : v.judged) {
    const std::string name = j.point->at("technique").get<std::string>();
    if (std::find(techniques.begin(), techniques.end(), name) == techniques.end()) techniques.push_back(name);
  }
  std::sort(techniques.begin(), techniques.end());
  std::string out;
  for (size_t t = 0; t < techniques.size(); ++t) {
    const char* color = kColors[t % kColors.size()];
    const size_t line = t / 5;
    const double column = kLeft + double(t % 5) * 130, row = kHeight + double(line) * kLegendRow;
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>", column,
                       row, color, column + 9, row + 4, escaped(techniques[t]));
    for (const Judged& j : v.judged) {
      if (j.point->at("technique") != techniques[t]) continue;
      out += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" fill-opacity=\"{}\"><title>{}: {} ms, {}"
          "</title></circle>",
          x.at(j.time_ms), y.at(shown_error(j)), j.is_default ? 6 : 4, color, j.is_default ? 1 : 0.65, escaped(j.label),
          figure(j.time_ms), percent(j.error_percent));
    }
  }
  return out;
}

}  // namespace

std::string plot_svg(const Verdict& v, bool standalone) {
  if (v.judged.empty()) return "";
  const auto [smallest, largest] =
      std::minmax_element(v.judged.begin(), v.judged.end(),
                          [](const Judged& a, const Judged& b) { return shown_error(a) < shown_error(b); });
  const Axis x = axis(v.judged.front().time_ms, v.judged.back().time_ms, kLeft, kWidth - kRight);
  const Axis y = axis(shown_error(*smallest), shown_error(*largest), kHeight - kBottom - kLegendRow, kTop);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" class=\"plot-svg\" role=\"img\" "
      "font-size=\"12\" "
      "font-family=\"sans-serif\"><title>{}, {} light: error against time</title>",
      kWidth, kHeight + 2 * kLegendRow, escaped(v.scene), v.light);
  if (standalone) {
    out +=
        "<style>text{fill:#222}.grid{stroke:#ddd;fill:none}.front{stroke:#222;fill:none;stroke-dasharray:5 3}</style>"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>";
  }
  return out + axes(x, y) + front_path(v, x, y) + techniques_points(v, x, y) + "</svg>\n";
}

}  // namespace volgi::app
