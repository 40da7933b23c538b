// The marks in a sheet's margin by which a camera finds the film on the water.
#pragma once

#include <vector>

#include "tags/mark.h"

namespace hydrodip {

// From this id on tags belong to boards; below, to sheets.
inline constexpr int kFirstBoardTag = 100;

// Film coordinates, as seen from above. Eight to ten: two in every corner and one halfway up the
// left and the right edge; those at the bottom give way to the ruler on narrow sheets. None where
// the margin is under 6 mm, or the sheet's sides under 120 mm: there the texts need the room.
// Sheets of other sizes have other tags, so that they are seldom taken for each other.
// They stand off the paper's edge by a third of the margin, up to 3.5 mm, which many printers leave
// white, and off the free film by a cell.
std::vector<MarkPlace> film_marks(double width_mm, double height_mm, double margin_mm);

// How much of a sheet's edge tape may cover: with marks no more than what lies outside of them,
// else the margin.
double tape_mm(double width_mm, double height_mm, double margin_mm, bool with_marks);

}  // namespace hydrodip
