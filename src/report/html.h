// Pieces of which the report's pages are made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/findings.h"
#include "report/report.h"

namespace hydrodip {

// Text for element content and quoted attributes alike; control bytes become spaces.
std::string html_escaped(const std::string& text);

// Everything above the page's own content, and below it. `audience`: of the page's data-for.
std::string html_begin(const std::string& title, const std::string& audience);
std::string html_end(const ReportPictures& pictures);

// Whether the page has the 3D view.
bool has_view(const ReportPictures& pictures);

// Empty without a picture.
std::string html_picture(const std::vector<std::uint8_t>& png, const std::string& alt);
std::string html_logo(const ReportPictures& pictures);
// The still picture; the viewer (viewer/main.js) builds itself in there and takes its place.
std::string html_preview(const ReportPictures& pictures);
std::string html_verdict(Concern concern, const std::string& headline, const std::string& sentence);
std::string html_row(const std::string& label, const std::string& value);  // of a table
std::string html_cards(const std::vector<Finding>& findings);

// report_html() for the person who ordered the piece.
std::string customer_html(const Report& report, const ReportPictures& pictures);

}  // namespace hydrodip
