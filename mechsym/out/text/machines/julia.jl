function curve((state, ratio, periodic, breaks, rows), x)
    at = ratio * x[state]
    inside = periodic ? breaks[1] + mod(at - breaks[1], breaks[end] - breaks[1]) : clamp(at, breaks[1], breaks[end])
    i = clamp(searchsortedlast(breaks, inside), 1, length(breaks) - 1)
    z, value, slope = inside - breaks[i], 0.0, 0.0
    for c in rows[:, i]
        slope = slope * z + value
        value = value * z + c
    end
    return value, (periodic || inside == at) ? slope : 0.0
end

# t [s], x states, u added to the inputs, p parameters
function values(t, x, u, p)
    w = [a for c in curves for a in curve(c, x)]
    return [t; x; u; p; w; [t >= p[i] ? 1.0 : 0.0 for i in switches]]
end
derivative(t, x, u, p) = rates(values(t, x, u, p))
outputs(t, x, u, p) = observed(values(t, x, u, p))
