function w = curve(at, periodic, breaks, rows)
    if periodic
        inside = breaks(1) + mod(at - breaks(1), breaks(end) - breaks(1));
    else
        inside = min(max(at, breaks(1)), breaks(end));
    end
    i = min(max(find(breaks <= inside, 1, 'last'), 1), numel(breaks) - 1);
    z = inside - breaks(i);
    value = 0.0; slope = 0.0;
    for c = rows(i, :)
        slope = slope * z + value;
        value = value * z + c;
    end
    if ~periodic && inside ~= at, slope = 0.0; end
    w = [value; slope];
end

function dx = derivative(t, x, u, p)
    dx = rates(values(t, x, u, p));
end

function y = outputs(t, x, u, p)
    y = observed(values(t, x, u, p));
end
