# quoted_text(FILE RESULT): the file's text as a literal of C++.
function(quoted_text file result)
  file(READ ${file} text)
  if(text MATCHES "[)]page\"")
    message(FATAL_ERROR "${file} holds the mark that ends its quotation.")
  endif()
  set(${result} "R\"page(${text})page\"" PARENT_SCOPE)
endfunction()
