-- A plane flow that draws out along x.
function velocity(x, y, z)
    return params.rate*x, -params.rate*y, 0
end
