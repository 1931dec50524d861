// node-ar-drone as its users run it: take-off and hover, with all navdata. Argument: seconds.
const client = require('ar-drone').createClient({ ip: '127.0.0.1' });
client.config('general:navdata_demo', 'FALSE');
client.on('navdata', () => {});
client.takeoff();
setTimeout(() => client.land(), Number(process.argv[2]) * 1000);
setTimeout(() => process.exit(0), Number(process.argv[2]) * 1000 + 500);
