/* Two masses with a spring between them, as FMI 2.0 and, with FMI3, as FMI 3.0: the torque of a motor acts on the first one. Steps
   inside are of 10 us, with Runge and Kutta's formula of fourth order. */
enum { TORQUE, SPEED, LOAD_SPEED, TWIST, ENERGY, ANGLE, J1, J2, STIFFNESS, DAMPING, VARIABLES_OF_MODEL };
#define VARIABLES VARIABLES_OF_MODEL
#define GUID "{f1e7cb0a-2c55-4a1e-8f0b-spring}"
#ifdef FMI3
#include "fmi3_model.h"
#else
#define HAS_STATE
#include "fmi2_model.h"
#endif

static void model_begin(Model* model) {
  model->values[J1] = 0.01;
  model->values[J2] = 0.02;
  model->values[STIFFNESS] = 100;
}

static void show(double* v) {
  v[ENERGY] = 0.5 * (v[J1] * v[SPEED] * v[SPEED] + v[J2] * v[LOAD_SPEED] * v[LOAD_SPEED] + v[STIFFNESS] * v[TWIST] * v[TWIST]);
}

static int model_initialize(Model* model) {
  show(model->values);
  return model->values[J1] > 0 && model->values[J2] > 0 ? 0 : 3;
}

/* Of the two speeds and the twist. */
static void rates(const double* v, const double* x, double* dx) {
  const double between = v[STIFFNESS] * x[2] + v[DAMPING] * (x[0] - x[1]);
  dx[0] = (v[TORQUE] - between) / v[J1];
  dx[1] = between / v[J2];
  dx[2] = x[0] - x[1];
}

static int model_step(Model* model, double time, double length) {
  (void)time;
  double* v = model->values;
  const int steps = (int)(length / 1e-5 + 0.5);
  const double h = length / steps;
  for (int n = 0; n < steps; ++n) {
    const double x[3] = {v[SPEED], v[LOAD_SPEED], v[TWIST]};
    double k[4][3], y[3];
    rates(v, x, k[0]);
    for (int part = 1; part < 4; ++part) {
      for (int i = 0; i < 3; ++i) y[i] = x[i] + h * (part == 3 ? 1 : 0.5) * k[part - 1][i];
      rates(v, y, k[part]);
    }
    const double before = v[SPEED];
    for (int i = 0; i < 3; ++i) y[i] = x[i] + h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    v[SPEED] = y[0];
    v[LOAD_SPEED] = y[1];
    v[TWIST] = y[2];
    v[ANGLE] += h * (before + v[SPEED]) / 2;
  }
  show(v);
  return 0;
}
