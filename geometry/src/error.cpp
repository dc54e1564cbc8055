#include "routebench/geometry/error.hpp"

namespace routebench {

Error::~Error() = default;

}  // namespace routebench
