/* Temperature and concentration of liquids: types of tobiuo.h, which includes this file. */
#ifndef TOBIUO_SCALAR_H
#define TOBIUO_SCALAR_H

#ifdef __cplusplus
extern "C" {
#endif

/* A scalar goes with the liquids and diffuses in them. Its amount is mass times capacity times value: J with
   a heat capacity, else kg times the unit of the value. */
typedef enum tobi_scalar_field { TOBI_TEMPERATURE, TOBI_CONCENTRATION } tobi_scalar_field;
enum { TOBI_SCALAR_LIMIT = 2, TOBI_SCALAR_VALUE_LIMIT = 64 };
typedef struct tobi_scalar_def {
    int    field;                  /* tobi_scalar_field, each once                                     */
    double value;                  /* of all liquid at the start; there liquids have their densities   */
    double diffusivity;            /* m2/s                                                             */
    double expansion;              /* per unit: share of its density that liquid loses above `value`   */
    double capacity;               /* J/(kg K), or 1                                                   */
    double turbulent_number;       /* 1: of Prandtl or Schmidt, of eddies below the spacing            */
    double thinning;               /* per unit: viscosities go as exp(-thinning (c - value))           */
} tobi_scalar_def;

/* Where a scalar has another value, or what comes through a wall: just one of box, fluid, inlet, side and
   body is given. */
#define TOBI_NO_VALUE (-1e9)
typedef enum tobi_scalar_side {
    TOBI_SIDE_NONE, TOBI_X_MIN, TOBI_X_MAX, TOBI_Y_MIN, TOBI_Y_MAX, TOBI_Z_MIN, TOBI_Z_MAX
} tobi_scalar_side;
typedef struct tobi_scalar_value_def {
    const char *name;              /* NULL: that of the side, body, fluid or inlet                     */
    int    field;                  /* tobi_scalar_field                                                */
    int    side;                   /* tobi_scalar_side, of the domain                                  */
    const char *body, *fluid, *inlet;
    double box_min[3], box_max[3]; /* m, of liquid at the start; without an inside: none               */
    double value;                  /* TOBI_NO_VALUE: flux instead                                      */
    double flux;                   /* amount/(m2 s) into the liquid, of a side or body                 */
    double transfer;               /* amount/(m2 s) per unit between value and liquid; 0: perfect         */
    double heat_capacity;          /* amount per unit, 2-D: per m, of a side or body; 0: keeps its value  */
    double power;                  /* amount/s, 2-D: per m, that one with a heat capacity gets            */
} tobi_scalar_value_def;

/* A scalar of the liquids of a world. */
typedef struct tobi_scalar_info {
    const char *field, *unit;      /* "temperature", "degC"                                            */
    double least, mean, most;      /* of the particles, mean by mass                                   */
    double amount;                 /* beyond that at the value of the definition, in 2-D per m         */
} tobi_scalar_info;

/* A side or body with a value or a flux. */
typedef struct tobi_scalar_flow {
    const char *field, *unit;      /* as in tobi_scalar_info                                           */
    double flow;                   /* amount/s into the liquid, last step, 2-D: per m; 0 after a load      */
    int    stores;                 /* 1: it has a heat capacity                                        */
    double value;                  /* of it now; NAN where a flux is given                             */
} tobi_scalar_flow;

#ifdef __cplusplus
}
#endif
#endif
