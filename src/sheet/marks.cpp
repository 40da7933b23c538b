#include "sheet/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/unicode.h"
#include "sheet/film_marks.h"
#include "sheet/winansi.h"

namespace hydrodip {

namespace {

constexpr double kFullMarginMm = 7;   // marks have their full size from this margin on
constexpr double kLeastMarginMm = 1;  // nothing is drawn in less
constexpr double kTextPt = 7;
constexpr double kLeastTextPt = 4.5;  // smaller is illegible on an inkjet
constexpr double kLabelPt = 5;
constexpr double kLeastLabelPt = 3.5;
constexpr double kCapHeight = 0.72;  // of the font size: Helvetica's capitals and digits
constexpr double kRulerMm = 100;
constexpr double kShortestRulerMm = 10;
constexpr double kRulerRoomMm = 25;        // what a full ruler leaves free of the sheet's width
constexpr double kLeastNamePt = 6;         // a long job name is shortened rather than made smaller
constexpr std::size_t kLongestName = 300;  // bytes
constexpr const char* kEllipsis = "\u2026";

// Where a text may stand: a stretch of base line.
struct Slot {
  enum class Edge { kTop, kBottom, kLeft, kRight };
  Edge edge;
  double begin_mm, end_mm;  // along the reading direction, from the page's left or bottom ...
  bool align_end;           // ... or, on the right edge, from its top
  bool taken = false;
};

double longest_ruler(double width_mm) {
  return std::min(kRulerMm, 10 * std::floor((width_mm - kRulerRoomMm + 1e-9) / 10));
}

class MarkMaker {
 public:
  MarkMaker(const SheetOptions& options, const TextWidth& text_width)
      : options_(options),
        text_width_(text_width),
        width_(options.width_mm),
        height_(options.height_mm),
        margin_(options.margin_mm),
        scale_(std::min(1.0, options.margin_mm / kFullMarginMm)) {}

  Marks make() {
    if (margin_ < kLeastMarginMm) {
      warn("has no room for any marks; check the print's size and orientation yourself");
      return marks_;
    }
    marks_.line_mm *= std::max(0.5, scale_);
    ruler();
    centre_ticks();
    if (options_.disc) disc_rim();
    if (kTextPt * scale_ < kLeastTextPt) {
      warn("has no room for texts; mark the sheet's top and upper side yourself");
      return marks_;
    }
    make_slots();
    camera_marks();
    orientation();
    alarm();
    reminders();
    job_name();
    return marks_;
  }

 private:
  using Edge = Slot::Edge;
  enum SlotName {
    kTopLeft,
    kTopRight,
    kBottomLeft,
    kBottomRight,
    kLeftUpper,
    kLeftLower,
    kRightUpper,
    kRightLower,
    kSlotCount
  };

  void warn(const std::string& what) {
    marks_.warnings.push_back(fmt::format("The film's margin of {:g} mm {}.", margin_, what));
  }

  void line(const Vec2& from, const Vec2& to) { marks_.lines.push_back({from, to}); }

  // The ruler hangs from a line just below the free film; its middle is the sheet's middle.
  double ruler_length() const { return longest_ruler(width_); }
  double ruler_y() const { return margin_ - 0.7 * scale_; }
  double tick_length(int mm) const {
    return scale_ * (mm % 10 == 0 ? 2.6 : mm % 5 == 0 ? 1.9 : 1.2);
  }
  double label_size() const { return kLabelPt * scale_; }
  bool has_labels() const { return label_size() >= kLeastLabelPt; }
  double label_base() const {
    return ruler_y() - scale_ * (2.6 + 0.35) - kCapHeight * label_size() * kMmPerPt;
  }

  void ruler() {
    const int length = static_cast<int>(ruler_length());
    if (length < kShortestRulerMm) {
      marks_.warnings.push_back(fmt::format(
          "A sheet {:g} mm wide has no room for a ruler; check the print's size yourself.",
          width_));
      return;
    }
    const double left = 0.5 * (width_ - length);
    line({left, ruler_y()}, {left + length, ruler_y()});
    for (int mm = 0; mm <= length; ++mm) {
      line({left + mm, ruler_y()}, {left + mm, ruler_y() - tick_length(mm)});
      if (mm % 10 == 0 && has_labels()) ruler_label(left + mm, mm, mm == length);
    }
  }

  void ruler_label(double x, int mm, bool last) {
    const std::string number = std::to_string(mm);
    const double start = x - 0.5 * length_of(number, label_size());
    add_text(last ? number + " mm" : number, {start, label_base()}, 0, label_size());
  }

  // From the edge to the free film; the one at the bottom spares the ruler's label.
  void centre_ticks() {
    const double inner = margin_ - 0.5 * marks_.line_mm;
    const double x = 0.5 * width_;
    const double y = 0.5 * height_;
    line({x, height_}, {x, height_ - inner});
    line({0, y}, {inner, y});
    line({width_, y}, {width_ - inner, y});
    const bool label_in_the_way =
        has_labels() && ruler_length() > 0 && static_cast<int>(ruler_length()) % 20 == 0;
    if (label_in_the_way) {
      line({x, 0}, {x, label_base() - 0.5 * scale_});
      line({x, ruler_y() - tick_length(0)}, {x, inner});
    } else {
      line({x, 0}, {x, inner});
    }
  }

  // Just outside the free film, so that the line itself stays in the margin.
  void disc_rim() {
    const double radius = 0.5 * std::min(width_, height_) - margin_ + 0.5 * marks_.line_mm;
    marks_.dashed.push_back({{0.5 * width_, 0.5 * height_}, radius});
  }

  // Printers leave some millimetres at the paper's edge white: texts keep off it.
  double edge_clearance() const { return 0.5 * margin_; }
  double text_centre() const { return 0.62 * margin_; }  // from the paper's edge

  void make_slots() {
    const double clear = edge_clearance();
    const double gap = 2 * scale_;
    const double ruler_half =
        ruler_length() < kShortestRulerMm
            ? gap
            : 0.5 * ruler_length() + 2 * gap + (has_labels() ? length_of("0 mm", label_size()) : 0);
    const double x = 0.5 * width_;
    const double y = 0.5 * height_;
    slots_ = {Slot{Edge::kTop, clear, x - gap, false},
              Slot{Edge::kTop, x + gap, width_ - clear, false},
              Slot{Edge::kBottom, clear, x - ruler_half, false},
              Slot{Edge::kBottom, x + ruler_half, width_ - clear, true},
              // The corners belong to the texts above.
              Slot{Edge::kLeft, y + gap, height_ - margin_, false},
              Slot{Edge::kLeft, margin_, y - gap, true}, Slot{Edge::kRight, margin_, y - gap, true},
              Slot{Edge::kRight, y + gap, height_ - margin_, false}};
  }

  // Texts give way to them.
  void camera_marks() {
    if (!options_.camera_marks) return;
    const Vec2 middle = 0.5 * Vec2(width_, height_);
    for (const MarkPlace& mark : film_marks(width_, height_, margin_)) {
      for (const Box2& box : mark_boxes(mark)) marks_.boxes.push_back(on_page(box));
      const Box2 outline = on_page(mark_outline(mark));
      if (outline.max.x() < margin_)
        keep_off(outline.min.y(), outline.max.y(), Edge::kLeft);
      else if (outline.min.x() > width_ - margin_)
        keep_off(height_ - outline.max.y(), height_ - outline.min.y(), Edge::kRight);
      else
        keep_off(outline.min.x(), outline.max.x(),
                 outline.min.y() > middle.y() ? Edge::kTop : Edge::kBottom);
    }
  }

  // From film coordinates; a sheet that is laid ink side down is printed mirrored.
  Box2 on_page(const Box2& box) const {
    const Vec2 middle = 0.5 * Vec2(width_, height_);
    Box2 page;
    for (const Vec2& corner : {box.min, box.max})
      page.add(middle + Vec2(options_.ink_side_up ? corner.x() : -corner.x(), corner.y()));
    return page;
  }

  // Where a stretch of an edge is taken, its texts keep to the longer part of what is left.
  void keep_off(double begin_mm, double end_mm, Edge edge) {
    const double gap = 1.5 * scale_;
    for (Slot& slot : slots_) {
      if (slot.edge != edge || end_mm < slot.begin_mm || begin_mm > slot.end_mm) continue;
      if (begin_mm - slot.begin_mm > slot.end_mm - end_mm)
        slot.end_mm = std::min(slot.end_mm, begin_mm - gap);
      else
        slot.begin_mm = std::max(slot.begin_mm, end_mm + gap);
    }
  }

  // The texts that an operator needs. A sheet laid ink side down is turned over about its vertical
  // axis: its top stays, its left and right change sides.
  void orientation() {
    const double arrow_mm = 0.8 * kTextPt * kMmPerPt * scale_;
    const bool up = options_.ink_side_up;
    slots_[kTopRight].begin_mm += arrow_mm + 0.8 * scale_;
    const bool placed =
        place(up ? "TOP: this side up" : "TOP: this side down, image mirrored", {kTopRight}) ||
        place(up ? "this side up" : "this side down", {kTopRight});
    if (placed) arrow(0.5 * width_ + 2 * scale_ + 0.5 * arrow_mm, arrow_mm);
    const bool left = place("this edge left", {up ? kLeftUpper : kRightUpper});
    const bool right = place("this edge right", {up ? kRightUpper : kLeftUpper});
    if (!placed || !(left || right)) {
      marks_.warnings.push_back(
          "The film is too small for the orientation texts; mark its top yourself.");
    }
  }

  // Where its text stands, and as wide as the margin lets it be.
  void alarm() {
    if (options_.alarm.empty()) return;
    const std::size_t before = marks_.texts.size();
    const std::string whole = tidy_utf8(options_.alarm);
    const std::string shorter = whole.substr(0, whole.find(':'));
    if (!place(whole, {kLeftLower, kRightLower}) && !place(shorter, {kLeftLower, kRightLower})) {
      warn("has no room for the alarm");
      return;
    }
    const MarkText text = marks_.texts[before];
    marks_.texts.pop_back();
    const double cap_mm = kCapHeight * text.size_pt * kMmPerPt, pad_mm = 0.6 * cap_mm;
    // Reads upward on the left edge, downward on the right one.
    const bool up = text.quarter_turns > 0;
    Box2 box;
    box.add(text.start + Vec2(up ? -cap_mm - pad_mm : -pad_mm, up ? -pad_mm : pad_mm));
    box.add(text.start + Vec2(up ? pad_mm : cap_mm + pad_mm,
                              up ? text.length_mm + pad_mm : -text.length_mm - pad_mm));
    marks_.bands.push_back({box, text});
  }

  // Points to the sheet's top edge.
  void arrow(double x, double size) {
    const double low = height_ - text_centre() - 0.45 * size;
    marks_.filled.push_back(
        {Vec2(x - 0.5 * size, low), Vec2(x + 0.5 * size, low), Vec2(x, low + 0.9 * size)});
  }

  void reminders() {
    place("Print at 100 %, no scaling", {kBottomRight, kRightLower, kLeftLower, kBottomLeft}) ||
        place("Print at 100 %", {kRightLower, kLeftLower});
    const double length = ruler_length();
    std::string film = fmt::format("Film {:.4g} x {:.4g} mm", width_, height_);
    if (length >= kShortestRulerMm && length < kRulerMm)
      film += fmt::format(", ruler {:g} mm", length);
    place(film, {kBottomLeft, kLeftLower, kRightLower});
  }

  void job_name() {
    const std::string name = cut_utf8(tidy_utf8(options_.job_name), kLongestName);
    const double least = std::max(kLeastTextPt, kLeastNamePt * scale_);
    if (name.empty() || place(name, {kTopLeft}, least)) return;
    const auto shortened = [&](std::size_t bytes) {
      std::string words = cut_utf8(name, bytes);
      while (words.ends_with(' ')) words.pop_back();
      return words + kEllipsis;
    };
    // Each longer piece is about as long as the one before and a letter.
    std::size_t fits = 0, too_long = name.size();
    while (too_long - fits > 1) {
      const std::size_t bytes = (fits + too_long) / 2;
      (has_room(shortened(bytes), slots_[kTopLeft], least) ? fits : too_long) = bytes;
    }
    if (shortened(fits) != kEllipsis) place(shortened(fits), {kTopLeft}, least);
  }

  // In the first free slot that takes the text, as large as it fits; false if none does.
  bool place(const std::string& text, std::initializer_list<SlotName> names,
             double least_pt = kLeastTextPt) {
    for (const SlotName name : names) {
      Slot& slot = slots_[name];
      if (slot.taken || !has_room(text, slot, least_pt)) continue;
      const double size = size_in(slot, text);
      slot.taken = true;
      const double length = length_of(text, size);
      write_along(slot, text, slot.align_end ? slot.end_mm - length : slot.begin_mm, size);
      return true;
    }
    return false;
  }

  // The largest size at which a slot takes the text.
  double size_in(const Slot& slot, const std::string& text) const {
    return std::min(kTextPt * scale_, (slot.end_mm - slot.begin_mm) / length_of(text, 1));
  }
  bool has_room(const std::string& text, const Slot& slot, double least_pt) const {
    return size_in(slot, text) >= least_pt;
  }

  void write_along(const Slot& slot, const std::string& text, double along, double size) {
    // Capitals are centred on the line at text_centre() from the edge.
    const double half_cap = 0.5 * kCapHeight * size * kMmPerPt;
    const double centre = text_centre();
    switch (slot.edge) {
      case Edge::kTop:
        return add_text(text, {along, height_ - centre - half_cap}, 0, size);
      case Edge::kBottom:
        return add_text(text, {along, centre - half_cap}, 0, size);
      case Edge::kLeft:
        return add_text(text, {centre + half_cap, along}, 1, size);
      case Edge::kRight:
        return add_text(text, {width_ - centre - half_cap, height_ - along}, -1, size);
    }
  }

  void add_text(const std::string& text, const Vec2& start, int quarter_turns, double size) {
    marks_.texts.push_back({text, start, quarter_turns, size, length_of(text, size)});
  }

  double length_of(const std::string& text, double size_pt) const {
    return text_width_(text) * size_pt * kMmPerPt;
  }

  const SheetOptions& options_;
  const TextWidth& text_width_;
  double width_, height_, margin_;
  double scale_;  // of all marks, 1 in margins of kFullMarginMm and more
  Marks marks_;
  std::array<Slot, kSlotCount> slots_{};
};

}  // namespace

double ruler_mm(double width_mm, double margin_mm) {
  const double length = longest_ruler(width_mm);
  return margin_mm < kLeastMarginMm || length < kShortestRulerMm ? 0 : length;
}

Marks make_marks(const SheetOptions& options, const TextWidth& text_width) {
  return MarkMaker(options, text_width).make();
}

}  // namespace hydrodip
