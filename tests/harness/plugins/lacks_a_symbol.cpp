/// A plugin that uses a function of the program that there is not.

#include "routebench/planning/plugin.hpp"

namespace routebench {
int from_a_later_version(int number);
}

ROUTEBENCH_REGISTER(lacks_a_symbol) {
  registry.set_origin(std::to_string(routebench::from_a_later_version(1)));
}
