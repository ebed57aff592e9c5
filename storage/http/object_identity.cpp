#include "storage/http/object_identity.h"

#include <span>

namespace planetree::storage {

Hash128 ObjectIdentity::key() const {
  const std::string text = url.substr(0, url.find('?')) + '\n' + etag + '\n' + last_modified +
                           '\n' + std::to_string(size_bytes);
  return hash128(std::as_bytes(std::span(text)));
}

}  // namespace planetree::storage
