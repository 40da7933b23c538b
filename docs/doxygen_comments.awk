# Makes Doxygen's comments of plain ones, line by line, so that warnings name the right line: what
# stands above a declaration explains it, what stands behind one too, and what a file begins with
# explains the file.
NR == 1 && /^\/\/ / { print "/// @file"; sub(/^\/\/ /, "/// "); print; in_head = 1; next }
in_head && /^\/\/ / { sub(/^\/\//, "///"); print; next }
in_head && /^#pragma once/ { in_head = 0; next }  # its line was spent on @file
{ in_head = 0 }
/^ *\/\/ (NOLINT|clang-format)/ { print; next }
/^ *\/\/( |$)/ {
  # A remark that goes on from behind a declaration stays with it.
  if (behind && match($0, /\/\//) > 3 && match($0, /\/\//) == behind) sub(/\/\//, "///<")
  else { sub(/\/\//, "///"); behind = 0 }
  print
  next
}
/[^ ].*  ?\/\/ / && !/^ *(using|namespace|}|#)/ {
  behind = match($0, /\/\/ /)
  sub(/\/\/ /, "///< ")
  print
  next
}
{ behind = 0; print }
