% Hertz's contact as a program for coatcheck, in the syntax that Octave 7 and MATLAB share.
while true
    line = fgetl(stdin);              % MATLAB: line = input('', 's');
    if ~ischar(line), break, end
    question = jsondecode(line);
    problem = question.problem;
    E = problem.substrate.E; nu = problem.substrate.nu; R = problem.radius; W = problem.load;
    a = (3*W*R*(1 - nu^2)/(4*E))^(1/3);
    p0 = 3*W/(2*pi*a^2);
    values = struct('contact', struct('contact_radius', a, 'approach', a^2/R, 'peak_pressure', p0));
    for points = question.lines(:)'
        if iscell(points), points = points{1}; end
        if any(strcmp(points.quantities, 'pressure'))
            p = p0*sqrt(max(1 - (points.x/a).^2, 0));
            values.(points.line) = struct('pressure', p);
        end
    end
    answer = struct('protocol', 'coatcheck-guest/1', 'id', question.id, 'values', values);
    printf('COATCHECK %s\n', jsonencode(answer));   % MATLAB: fprintf
    fflush(stdout);                                 % MATLAB: not needed
end
