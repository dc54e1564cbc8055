/// The planners of culprit.hpp as a plugin, as a stranger would build it.
#include "culprit.hpp"

ROUTEBENCH_REGISTER(culprit) {
  registry.add<routebench::test::Hatch>();
  registry.add<routebench::test::Culprit>();
}
