#include "report/html.h"

#include <fmt/format.h>

#include "export/packer.h"
#include "report/viewer_assets.h"

namespace hydrodip {

std::string html_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        const auto byte = static_cast<unsigned char>(c);
        const bool control = (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
        out += control ? ' ' : c;
    }
  }
  return out;
}

std::string html_begin(const std::string& title, const std::string& audience) {
  return "<!DOCTYPE html>\n<html lang=\"en\" data-for=\"" + audience +
         "\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         html_escaped(title) + "</title>\n<style>" + page_style() +
         "</style>\n</head>\n<body>\n<main>\n";
}

bool has_view(const ReportPictures& pictures) {
  return !pictures.scene.empty() && !viewer_script().empty();
}

std::string html_end(const ReportPictures& pictures) {
  std::string scripts;
  if (has_view(pictures))
    scripts = "<script type=\"application/json\" id=\"scene\">" + pictures.scene +
              "</script>\n<script>" + viewer_script() + "</script>\n";
  return "</main>\n" + scripts + "</body>\n</html>\n";
}

std::string html_picture(const std::vector<std::uint8_t>& png, const std::string& alt) {
  if (png.empty()) return "";
  return "<img alt=\"" + alt + "\" src=\"data:image/png;base64," + base64(png) + "\">\n";
}

std::string html_logo(const ReportPictures& pictures) {
  if (pictures.logo_png.empty()) return "";
  return "<div class=\"logo\">" + html_picture(pictures.logo_png, "Logo") + "</div>\n";
}

std::string html_preview(const ReportPictures& pictures) {
  return "<section id=\"viewer\" hidden></section>\n<div id=\"still\">\n" +
         html_picture(pictures.preview_png,
                      "The object as wanted beside the object as predicted, from two sides") +
         "</div>\n";
}

std::string html_verdict(Concern concern, const std::string& headline,
                         const std::string& sentence) {
  return fmt::format(
      "<section class=\"verdict {}\" id=\"verdict\">\n<h2>{}</h2>\n<p>{}</p>\n</section>\n",
      concern_name(concern), headline, html_escaped(sentence));
}

std::string html_row(const std::string& label, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td></tr>\n",
                     html_escaped(label), html_escaped(value));
}

std::string html_cards(const std::vector<Finding>& findings) {
  if (findings.empty()) return "";
  std::string html = "<ul class=\"findings\">\n";
  for (const Finding& finding : findings) {
    html += fmt::format("<li class=\"{}\"><strong>{}</strong>", concern_name(finding.concern),
                        html_escaped(finding.title));
    if (!finding.figure.empty()) html += fmt::format(" <b>{}</b>", html_escaped(finding.figure));
    html += fmt::format(" <span>{}</span>", html_escaped(finding.text));
    if (!finding.advice.empty()) html += fmt::format(" <em>{}</em>", html_escaped(finding.advice));
    html += "</li>\n";
  }
  return html + "</ul>\n";
}

}  // namespace hydrodip
