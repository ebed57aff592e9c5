# planetree_embed_files(TARGET name type path [name type path...])
#
# Makes files part of a target: their bytes, and a table of them, which tools/view/embedded_files.h
# declares. The bytes are in a source in assembler: a cache of compilers would not see that they
# changed, as they are in no text that the compiler reads.
enable_language(ASM)
function(planetree_embed_files target)
  set(bytes "")
  set(symbols "")
  set(rows "")
  set(paths "")
  set(rest ${ARGN})
  set(number 0)
  while(rest)
    list(POP_FRONT rest name type path)
    list(APPEND paths ${path})
    set(symbol planetree_embedded_${number})
    string(APPEND bytes "  .balign 16
  .hidden ${symbol}
  .globl ${symbol}
${symbol}:
  .incbin \"${path}\"
  .hidden ${symbol}_end
  .globl ${symbol}_end
${symbol}_end:
  .byte 0
")
    string(APPEND symbols "extern \"C\" const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND rows "    {\"${name}\", \"${type}\", {${symbol}, ${symbol}_end}},\n")
    math(EXPR number "${number} + 1")
  endwhile()
  set(assembler ${CMAKE_CURRENT_BINARY_DIR}/embedded_bytes.s)
  file(CONFIGURE OUTPUT ${assembler} @ONLY
    CONTENT "  .section .rodata\n@bytes@  .section .note.GNU-stack,\"\",%progbits\n")
  # clang complains of options for C++.
  set_source_files_properties(${assembler} PROPERTIES
    OBJECT_DEPENDS "${paths}" COMPILE_OPTIONS -Wno-unused-command-line-argument)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT [[#include "tools/view/embedded_files.h"

@symbols@
namespace planetree::tools {

std::span<const PageFile> embedded_files() {
  static const PageFile files[] = {
@rows@  };
  return files;
}

}  // namespace planetree::tools
]] @ONLY)
  set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${source} ${assembler})
endfunction()
