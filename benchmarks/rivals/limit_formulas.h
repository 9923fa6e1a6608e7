/* The formulas of limit.c on NUMBERs, which it defines as doubles and as vectors of them, with ROOT, NINE and SOLVE. */

typedef struct { NUMBER F12x, F12y, F32x, F32y, F43x, F43y, F14x, F14y, T12; } NINE;

static inline NINE SOLVE(const Constants k, NUMBER cos2, NUMBER sin2, NUMBER sin_half2, NUMBER cos_half2)
{
    /* position: two circles meet at C */
    NUMBER Bx = k.a * cos2, By = k.a * sin2, rx = k.d - Bx;   /* ry = -By */
    NUMBER low = k.low0 + k.ad * sin_half2, high = k.high0 + k.ad * cos_half2, f2 = low + k.gap;
    NUMBER det = k.sign * ROOT(low * high), shared = 0.5 / (f2 * det);
    NUMBER scale = shared * det, idet = shared * f2, across = scale * det;
    NUMBER along = scale * (low + k.along_u), alongv = scale * (k.along_v - low);
    NUMBER px = across * By, py = across * rx;
    NUMBER ux = px + along * rx, uy = py - along * By, vx = px + alongv * rx, vy = py - alongv * By;

    /* rates squared; accelerations, C's seen from both sides */
    NUMBER rate = k.omega2 * idet, omega3 = (By * vx - Bx * vy) * rate, omega4 = (By * ux - Bx * uy) * rate;
    NUMBER w3 = omega3 * omega3, w4 = omega4 * omega4;
    NUMBER ax = k.gx + k.radial * cos2 + k.tangential * sin2;   /* gravity less the acceleration of B */
    NUMBER ay = k.gy + k.radial * sin2 - k.tangential * cos2;
    NUMBER Kx = ax - k.gx + w3 * ux - w4 * vx, Ky = ay - k.gy + w3 * uy - w4 * vy;
    NUMBER alpha3 = (Kx * vx + Ky * vy) * idet, alpha4 = (Kx * ux + Ky * uy) * idet;

    /* d'Alembert: Q force of weight and inertia on a link, -M their moment about its first pin */
    NUMBER hx = k.k3 * ux - k.l3 * uy, hy = k.k3 * uy + k.l3 * ux;
    NUMBER ix = k.k4 * vx - k.l4 * vy, iy = k.k4 * vy + k.l4 * vx;
    NUMBER Q3x = k.m3 * ax + alpha3 * hy + w3 * hx, Q3y = k.m3 * ay - alpha3 * hx + w3 * hy;
    NUMBER Q4x = k.m4gx + alpha4 * iy + w4 * ix, Q4y = k.m4gy - alpha4 * ix + w4 * iy;
    NUMBER M2 = k.M2 - k.M2c * cos2 + k.M2s * sin2;
    NUMBER M3 = k.J3 * alpha3 + hy * ax - hx * ay, M4 = k.J4 * alpha4 + iy * k.gx - ix * k.gy;

    /* the two moments of the dyad give F43, sums of forces and of moments the rest */
    NUMBER n3 = M3 * idet, n4 = M4 * idet;
    NINE f;
    f.F43x = n4 * ux + n3 * vx, f.F43y = n4 * uy + n3 * vy;
    f.F32x = f.F43x + Q3x, f.F32y = f.F43y + Q3y;
    f.F14x = f.F43x - Q4x, f.F14y = f.F43y - Q4y;
    f.F12x = k.P2x - k.P2r * cos2 - k.P2t * sin2 - f.F32x, f.F12y = k.P2y - k.P2r * sin2 + k.P2t * cos2 - f.F32y;
    f.T12 = M2 + By * f.F32x - Bx * f.F32y;
    return f;
}
