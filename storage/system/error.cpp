#include "planetree/error.h"

#include <cstdarg>
#include <cstdio>

namespace planetree {

Error make_error(ErrorCode code, std::uint64_t page, std::uint64_t offset, const char* format,
                 ...) noexcept {
  Error error;
  error.code = code;
  error.page = page;
  error.offset = offset;
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(error.text, sizeof error.text, format, arguments);
  va_end(arguments);
  return error;
}

}  // namespace planetree
