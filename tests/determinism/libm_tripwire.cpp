// Preloaded before hash_probe: any call of a libm transcendental or of BLAS and LAPACK, by our code
// or inside Simbody, ends the process with status 86 and the name of what was called.
#include <unistd.h>

#include <cstring>

namespace {

volatile bool armed = false;

void trip(const char* name) {
  const char message[] = "libm_tripwire: somebody calls ";
  (void)!write(2, message, sizeof message - 1);
  (void)!write(2, name, std::strlen(name));
  (void)!write(2, "\n", 1);
  _exit(86);
}

}  // namespace

// hash_probe calls it first of all: what static initialisers of libraries call is of no interest.
extern "C" void rubble_arm_tripwire() { armed = true; }

// The results are never used: before arming they are those of static initialisers, 0 or 1.
#define RUBBLE_TRIP(name)    \
  extern "C" double name() { \
    if (armed) trip(#name);  \
    return 0;                \
  }
#define RUBBLE_TRIP_FLOAT(name) \
  extern "C" float name() {     \
    if (armed) trip(#name);     \
    return 0;                   \
  }
#define RUBBLE_TRIP_BOTH(name) RUBBLE_TRIP(name) RUBBLE_TRIP_FLOAT(name##f)
#define RUBBLE_TRIP_BLAS(name) RUBBLE_TRIP(s##name##_) RUBBLE_TRIP(d##name##_)

RUBBLE_TRIP_BOTH(sin)
RUBBLE_TRIP_BOTH(cos)
RUBBLE_TRIP_BOTH(sincos)
RUBBLE_TRIP_BOTH(tan)
RUBBLE_TRIP_BOTH(asin)
RUBBLE_TRIP_BOTH(acos)
RUBBLE_TRIP_BOTH(atan)
RUBBLE_TRIP_BOTH(atan2)
RUBBLE_TRIP_BOTH(sinh)
RUBBLE_TRIP_BOTH(cosh)
RUBBLE_TRIP_BOTH(tanh)
RUBBLE_TRIP_BOTH(exp)
RUBBLE_TRIP_BOTH(exp2)
RUBBLE_TRIP_BOTH(expm1)
RUBBLE_TRIP_BOTH(log)
RUBBLE_TRIP_BOTH(log2)
RUBBLE_TRIP_BOTH(log10)
RUBBLE_TRIP_BOTH(log1p)
RUBBLE_TRIP_BOTH(pow)
RUBBLE_TRIP_BOTH(cbrt)
RUBBLE_TRIP_BOTH(hypot)
RUBBLE_TRIP_BLAS(gemm)
RUBBLE_TRIP_BLAS(gemv)
RUBBLE_TRIP_BLAS(symv)
RUBBLE_TRIP_BLAS(syrk)
RUBBLE_TRIP_BLAS(trsm)
RUBBLE_TRIP_BLAS(trsv)
RUBBLE_TRIP_BLAS(dot)
RUBBLE_TRIP_BLAS(axpy)
RUBBLE_TRIP_BLAS(nrm2)
RUBBLE_TRIP_BLAS(asum)
RUBBLE_TRIP_BLAS(scal)
RUBBLE_TRIP_BLAS(getrf)
RUBBLE_TRIP_BLAS(getri)
RUBBLE_TRIP_BLAS(getrs)
RUBBLE_TRIP_BLAS(gesv)
RUBBLE_TRIP_BLAS(potrf)
RUBBLE_TRIP_BLAS(potrs)
RUBBLE_TRIP_BLAS(syev)
RUBBLE_TRIP_BLAS(geev)
RUBBLE_TRIP_BLAS(gelss)
