/* The public headers that python/tobiuo calls; the build makes its interface.h of them. */
#include "tobiuo/results.h"
#include "tobiuo/run.h"
#include "tobiuo/sample.h"
#include "tobiuo/scene.h"
#include "tobiuo/tobiuo.h"
