function place(t) return 0, 0, 0 end
