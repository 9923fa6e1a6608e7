/* The speed limit: the four-bar's fused formulas as a C compiler compiles them at its best.
 *
 * Links are 2 crank, 3 coupler, 4 rocker; r = D - B, u = C - B, v = C - D, det = u x v / 2, idet = 1 / (u x v).
 * Numbers of a design alone are computed once, in Constants. low, high and f2 = |r|^2 are stored as quarters, so that
 * no factor 2 is left in the loop, and one division serves both 1 / f2 and 1 / det.
 * Angles that cannot be assembled give NaN.
 */
#include <math.h>
#include <stdint.h>

/* A design as limit.py packs it: centres of gravity (x, y) along and across the link from its first pin. */
typedef struct {
    double a, b, c, d, m2, m3, m4, I2, I3, I4, x2, y2, x3, y3, x4, y4, omega2, alpha2, gx, gy, sign;
} Design;

typedef struct {
    double a, d, ad, low0, high0, gap, along_u, along_v, sign;   /* closing the loop */
    double omega2, radial, tangential, gx, gy;                   /* rates and accelerations */
    double P2x, P2y, P2r, P2t, M2, M2c, M2s;                     /* crank: force and moment that its pins supply */
    double m3, k3, l3, J3, m4gx, m4gy, k4, l4, J4;               /* coupler, rocker */
} Constants;

typedef struct { double F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T12; } Nine;

static Constants prepare(const Design *p)
{
    double a = p->a, b = p->b, c = p->c, d = p->d, gx = p->gx, gy = p->gy;
    double square = p->omega2 * p->omega2, alpha = p->alpha2, hx = p->m2 * p->x2, hy = p->m2 * p->y2;
    return (Constants){
        .a = a, .d = d, .ad = a * d, .sign = p->sign, .gap = (b - c) * (b - c) / 4,
        .low0 = (d - a - b + c) * (d - a + b - c) / 4, .high0 = (b + c - d - a) * (b + c + d + a) / 4,
        .along_u = b * (b - c) / 2, .along_v = c * (b - c) / 2,
        .omega2 = p->omega2, .radial = square * a, .tangential = alpha * a, .gx = gx, .gy = gy,
        .P2x = -p->m2 * gx, .P2y = -p->m2 * gy, .P2r = square * hx + alpha * hy, .P2t = alpha * hx - square * hy,
        .M2 = alpha * (p->I2 + hx * p->x2 + hy * p->y2), .M2c = hx * gy - hy * gx, .M2s = hy * gy + hx * gx,
        .m3 = p->m3, .k3 = p->m3 * p->x3 / b, .l3 = p->m3 * p->y3 / b,
        .J3 = p->I3 + p->m3 * (p->x3 * p->x3 + p->y3 * p->y3),
        .m4gx = p->m4 * gx, .m4gy = p->m4 * gy, .k4 = p->m4 * p->x4 / c, .l4 = p->m4 * p->y4 / c,
        .J4 = p->I4 + p->m4 * (p->x4 * p->x4 + p->y4 * p->y4),
    };
}

static inline Nine solve(Constants k, double cos2, double sin2, double sin_half2, double cos_half2)
{
    /* position: two circles meet at C */
    double Bx = k.a * cos2, By = k.a * sin2, rx = k.d - Bx;   /* ry = -By */
    double low = k.low0 + k.ad * sin_half2, high = k.high0 + k.ad * cos_half2, f2 = low + k.gap;
    double det = k.sign * sqrt(low * high), shared = 0.5 / (f2 * det);
    double scale = shared * det, idet = shared * f2, across = scale * det;
    double along = scale * (low + k.along_u), alongv = scale * (k.along_v - low);
    double px = across * By, py = across * rx;
    double ux = px + along * rx, uy = py - along * By, vx = px + alongv * rx, vy = py - alongv * By;

    /* rates squared; accelerations, C's seen from both sides */
    double rate = k.omega2 * idet, omega3 = (By * vx - Bx * vy) * rate, omega4 = (By * ux - Bx * uy) * rate;
    double w3 = omega3 * omega3, w4 = omega4 * omega4;
    double ax = k.gx + k.radial * cos2 + k.tangential * sin2;   /* gravity less the acceleration of B */
    double ay = k.gy + k.radial * sin2 - k.tangential * cos2;
    double Kx = ax - k.gx + w3 * ux - w4 * vx, Ky = ay - k.gy + w3 * uy - w4 * vy;
    double alpha3 = (Kx * vx + Ky * vy) * idet, alpha4 = (Kx * ux + Ky * uy) * idet;

    /* d'Alembert: Q force of weight and inertia on a link, -M their moment about its first pin */
    double hx = k.k3 * ux - k.l3 * uy, hy = k.k3 * uy + k.l3 * ux;
    double ix = k.k4 * vx - k.l4 * vy, iy = k.k4 * vy + k.l4 * vx;
    double Q3x = k.m3 * ax + alpha3 * hy + w3 * hx, Q3y = k.m3 * ay - alpha3 * hx + w3 * hy;
    double Q4x = k.m4gx + alpha4 * iy + w4 * ix, Q4y = k.m4gy - alpha4 * ix + w4 * iy;
    double M2 = k.M2 - k.M2c * cos2 + k.M2s * sin2;
    double M3 = k.J3 * alpha3 + hy * ax - hx * ay, M4 = k.J4 * alpha4 + iy * k.gx - ix * k.gy;

    /* the two moments of the dyad give F43, sums of forces and of moments the rest */
    double n3 = M3 * idet, n4 = M4 * idet;
    Nine f;
    f.F43x = n4 * ux + n3 * vx, f.F43y = n4 * uy + n3 * vy;
    f.F32x = f.F43x + Q3x, f.F32y = f.F43y + Q3y;
    f.F14x = f.F43x - Q4x, f.F14y = f.F43y - Q4y;
    f.F12x = k.P2x - k.P2r * cos2 - k.P2t * sin2 - f.F32x, f.F12y = k.P2y - k.P2r * sin2 + k.P2t * cos2 - f.F32y;
    f.T12 = M2 + By * f.F32x - Bx * f.F32y;
    return f;
}

/* The nine unknowns, in rows of n. Nothing aliases: without the simd pragma gcc 12 gives up on the nine rows. */
void store(int64_t n, const double *restrict cos2, const double *restrict sin2, const double *restrict sin_half2,
           const double *restrict cos_half2, const Design *design, double *restrict out)
{
    Constants k = prepare(design);
#pragma omp simd
    for (int64_t i = 0; i < n; i++) {
        Nine f = solve(k, cos2[i], sin2[i], sin_half2[i], cos_half2[i]);
        out[i] = f.F12x, out[n + i] = f.F12y, out[2 * n + i] = f.F32x, out[3 * n + i] = f.F32y;
        out[4 * n + i] = f.F43x, out[5 * n + i] = f.F43y, out[6 * n + i] = f.F14x, out[7 * n + i] = f.F14y;
        out[8 * n + i] = f.T12;
    }
}

enum { LANES = 16, SIGNALS = 6 };

static inline void keep(double *best, double *at, double value, double sample)
{
    int better = value > *best;
    *at = better ? sample : *at;
    *best = better ? value : *best;
}

/* Grid peaks of every design: largest |F12|, |F32|, |F43|, |F14|, largest T12, smallest T12 (kept as -T12), and the
 * first sample each is at, -1 for none. Lanes run along the angles and keep their own best, forces as squares, to the
 * end of the turn. n must be at least LANES.
 */
void peaks(int64_t n_designs, int64_t n, const double *restrict cos2, const double *restrict sin2,
           const double *restrict sin_half2, const double *restrict cos_half2, const Design *designs,
           double *restrict value, double *restrict at)
{
    for (int64_t j = 0; j < n_designs; j++) {
        Constants k = prepare(designs + j);
        double best[SIGNALS][LANES], when[SIGNALS][LANES];
        for (int s = 0; s < SIGNALS; s++)
            for (int l = 0; l < LANES; l++) best[s][l] = -INFINITY, when[s][l] = -1;
        for (int64_t i = 0; i < n; i += LANES) {
            int64_t start = i + LANES <= n ? i : n - LANES;   /* the last block steps back over samples seen */
            double sample = (double)start;
#pragma omp simd
            for (int l = 0; l < LANES; l++) {
                Nine f = solve(k, cos2[start + l], sin2[start + l], sin_half2[start + l], cos_half2[start + l]);
                keep(&best[0][l], &when[0][l], f.F12x * f.F12x + f.F12y * f.F12y, sample);
                keep(&best[1][l], &when[1][l], f.F32x * f.F32x + f.F32y * f.F32y, sample);
                keep(&best[2][l], &when[2][l], f.F43x * f.F43x + f.F43y * f.F43y, sample);
                keep(&best[3][l], &when[3][l], f.F14x * f.F14x + f.F14y * f.F14y, sample);
                keep(&best[4][l], &when[4][l], f.T12, sample);
                keep(&best[5][l], &when[5][l], -f.T12, sample);
            }
        }
        for (int s = 0; s < SIGNALS; s++) {
            double top = -INFINITY, first = INFINITY;   /* selects, no branches: these are not predictable */
            for (int l = 0; l < LANES; l++) top = best[s][l] > top ? best[s][l] : top;
            for (int l = 0; l < LANES; l++) {
                double here = best[s][l] == top ? when[s][l] + l : INFINITY;
                first = here < first ? here : first;
            }
            int none = top == -INFINITY;
            value[SIGNALS * j + s] = none ? NAN : s < 4 ? sqrt(top) : s == 4 ? top : -top;
            at[SIGNALS * j + s] = none ? -1 : first;
        }
    }
}
